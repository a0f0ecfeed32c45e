#include "plumb/engine/plan/lifetime.hpp"

#include <map>
#include <set>
#include <utility>

#include "plumb/engine/plan/wires.hpp"

namespace plumb {
namespace {

/// Who takes the results of a step.
struct Takers {
  int inputs = 0;      ///< of steps, and what repeats start with, carry and judge by
  int own_item = 0;    ///< of those: inputs that take the result of the call's own item
  int last_step = -1;  ///< the step of the last one; -1: a repeat
};

/// Decides over the results of each step, and says why.
class Lifetimes {
 public:
  explicit Lifetimes(const Plan& plan)
      : plan_(plan), repeat_of_(plan.steps.size(), -1), takers_(plan.steps.size()) {
    visit_steps(plan, plan.order, -1, [&](int step, int repeat) {
      repeat_of_[step] = repeat;
      ++uses_[plan.steps[step].description->name];
    });
    for (const PlannedItem& item : plan.order)
      visit_wires(plan, item, [&](int step, const Wire& wire, const InputDescription* port) {
        if (wire.step < 0) return;
        Takers& takers = takers_[wire.step];
        ++takers.inputs;
        takers.own_item += step >= 0 && port->access == Access::item &&
                           repeat_of_[step] == repeat_of_[wire.step] &&
                           description(step).items == description(wire.step).items;
        takers.last_step = step;
      });
  }

  Lifetime of(int s) const {
    const StepDescription& step = description(s);
    const Takers& takers = takers_[s];
    if (step.items && step.items->transient) return {Keeping::passing, why_transient(s)};
    if (large(s) && takers.inputs == 1 && takers.own_item == 1)
      return {Keeping::passing,
              "large, and only " + plan_.steps[takers.last_step].path + " takes them"};
    std::string why = large(s) ? why_not_passing(s) : but_lazy(step);
    const auto and_also = [&](const std::string& more) {
      return why.empty() ? more : why + "; " + more;
    };
    if (repeat_of_[s] >= 0) return {Keeping::remembered, and_also("in a repeat")};
    if (const int n = uses_.at(step.name); n > 1)
      return {Keeping::remembered, and_also(step.name + " occurs " + std::to_string(n) + " times")};
    if (why.empty()) why = step.items ? "not large" : "one call makes all";
    return {Keeping::kept, why};
  }

 private:
  const StepDescription& description(int step) const { return *plan_.steps[step].description; }

  bool large(int s) const {
    const StepDescription& step = description(s);
    return step.items && step.outputs.size() == 1 && step.outputs.front().type->large;
  }

  std::string why_transient(int s) const {
    const std::string why = description(s).items->name + "s are transient";
    const int inputs = takers_[s].inputs;
    return inputs > 1 ? why + ", made for each of " + std::to_string(inputs) + " inputs" : why;
  }

  std::string why_not_passing(int s) const {
    const Takers& takers = takers_[s];
    if (takers.inputs != 1)
      return "large, but " + std::to_string(takers.inputs) + " inputs take them";
    if (takers.last_step < 0) return "large, but a repeat takes them";
    const std::string taker = "large, but " + plan_.steps[takers.last_step].path;
    const int repeat = repeat_of_[takers.last_step];
    if (repeat != repeat_of_[s])
      return taker + (repeat >= 0 ? " takes them in each pass" : " takes them after the repeat");
    return taker + " takes several in a call";
  }

  static std::string but_lazy(const StepDescription& step) {
    std::string names;
    for (const OutputDescription& output : step.outputs)
      if (output.emission == Emission::lazy) names += (names.empty() ? "" : ", ") + output.name;
    return names.empty() ? "" : "all but " + names + ", opened whenever asked for";
  }

  const Plan& plan_;
  std::vector<int> repeat_of_;
  std::map<std::string, int> uses_;  ///< by a step's registered name
  std::vector<Takers> takers_;
};

}  // namespace

std::vector<std::vector<std::size_t>> users_of(const Plan& plan) {
  const auto lifetimes = keeping_of(plan);
  std::vector<std::set<std::size_t>> users(plan.steps.size());
  std::vector<std::pair<int, int>> passing;  // a step whose values pass, and one that it draws on
  for (std::size_t place = 0; place < plan.order.size(); ++place) {
    visit_steps(plan, {plan.order[place]}, -1, [&](int step, int) { users[step].insert(place); });
    visit_wires(plan, plan.order[place], [&](int step, const Wire& wire, const InputDescription*) {
      if (wire.step < 0) return;
      users[wire.step].insert(place);
      if (step >= 0 && lifetimes[step].keeping == Keeping::passing)
        passing.emplace_back(step, wire.step);
    });
  }
  for (bool more = true; more;) {
    more = false;
    for (const auto& [step, from] : passing) {
      const std::size_t known = users[from].size();
      users[from].insert(users[step].begin(), users[step].end());
      more |= users[from].size() > known;
    }
  }
  std::vector<std::vector<std::size_t>> places;
  places.reserve(users.size());
  for (const auto& of_step : users) places.emplace_back(of_step.begin(), of_step.end());
  return places;
}

std::vector<std::size_t> last_uses(const Plan& plan) {
  const auto users = users_of(plan);
  std::vector<std::size_t> last;
  last.reserve(users.size());
  for (const auto& places : users) last.push_back(places.back());
  return last;
}

std::vector<Lifetime> keeping_of(const Plan& plan) {
  const Lifetimes lifetimes(plan);
  std::vector<Lifetime> of;
  for (std::size_t s = 0; s < plan.steps.size(); ++s)
    of.push_back(lifetimes.of(static_cast<int>(s)));
  return of;
}

}  // namespace plumb
