#include "plumb/engine/plan/level.hpp"

#include <set>

#include "plumb/engine/plan/wires.hpp"

namespace plumb {
namespace {

/// Whether two steps would give the same for the same inputs, at least in some pass.
bool may_be_alike(const PlannedStep& a, const PlannedStep& b) {
  if (a.description != b.description) return false;
  for (std::size_t p = 0; p < a.parameters.size(); ++p) {
    const PlannedParameter &one = a.parameters[p], &other = b.parameters[p];
    const bool fixed = one.row < 0 && other.row < 0;
    if (a.description->parameters[p].affects_result && fixed && one.value != other.value)
      return false;
  }
  return true;
}

}  // namespace

Level level_of(const Plan& plan, const std::vector<PlannedItem>& items) {
  const std::size_t none = items.size();
  std::vector<std::size_t> item_of(plan.steps.size(), none);  // that a step is, or is in
  for (std::size_t k = 0; k < items.size(); ++k)
    visit_steps(plan, {items[k]}, -1, [&](int step, int) { item_of[step] = k; });
  Level level;
  level.before.resize(items.size());
  level.after.resize(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) {
    std::set<std::size_t> before;
    visit_wires(plan, items[k], [&](int, const Wire& wire, const InputDescription*) {
      if (wire.step >= 0 && item_of[wire.step] < k) before.insert(item_of[wire.step]);
    });
    visit_steps(plan, {items[k]}, -1, [&](int step, int) {
      for (std::size_t s = 0; s < plan.steps.size(); ++s)
        if (item_of[s] < k && may_be_alike(plan.steps[s], plan.steps[step]))
          before.insert(item_of[s]);
    });
    level.before[k].assign(before.begin(), before.end());
    for (const std::size_t earlier : before) level.after[earlier].push_back(k);
  }
  return level;
}

}  // namespace plumb
