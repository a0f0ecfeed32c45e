#include "plumb/engine/plan/loop.hpp"

#include <algorithm>

#include "plumb/data/short_number.hpp"

namespace plumb {

bool LoopJudge::holds(std::size_t c) const {
  const PlannedCondition& condition = repeat_.conditions[c];
  const double now = values_.back()[c];
  if (condition.below) return now < *condition.below;
  if (values_.size() < 2) return false;
  const double before = values_[values_.size() - 2][c];
  return before - now < *condition.falls_by_less_than * std::abs(before);
}

std::string LoopJudge::why(std::size_t c) const {
  const PlannedCondition& condition = repeat_.conditions[c];
  const double before = values_[values_.size() - 2][c], now = values_.back()[c];
  const std::string from = short_number(before), to = short_number(now);
  if (from == to) return condition.text + " (it stays at " + to + ")";
  const bool rose = condition.falls_by_less_than && now > before;
  return (rose ? condition.metric_text + " rose" : condition.text) + " (" + from + " -> " + to +
         ")";
}

std::optional<std::string> LoopJudge::after_pass(std::vector<double> values) {
  values_.push_back(std::move(values));
  if (!repeat_.conditions.empty() && passes() >= std::max(2, repeat_.at_least)) {
    std::string held;
    std::size_t count = 0;
    for (std::size_t c = 0; c < repeat_.conditions.size(); ++c) {
      if (!holds(c)) continue;
      ++count;
      held += (held.empty() ? "" : " and ") + why(c);
    }
    if (repeat_.all ? count == repeat_.conditions.size() : count > 0) return held;
  }
  if (passes() < repeat_.at_most) return std::nullopt;
  return repeat_.conditions.empty() ? "all passes are done"
                                    : "at_most is reached, until does not hold";
}

}  // namespace plumb
