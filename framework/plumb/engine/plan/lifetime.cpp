#include "plumb/engine/plan/lifetime.hpp"

#include <algorithm>
#include <functional>
#include <map>

namespace plumb {
namespace {

using Visit = std::function<void(int step, const Wire& wire, const InputDescription* port)>;

void visit_wires(const Plan& plan, const PlannedItem& item, const Visit& visit) {
  if (item.step >= 0) {
    const PlannedStep& step = plan.steps[item.step];
    for (std::size_t p = 0; p < step.inputs.size(); ++p)
      for (const Wire& wire : step.inputs[p]) visit(item.step, wire, &step.description->inputs[p]);
    return;
  }
  const PlannedRepeat& repeat = plan.repeats[item.repeat];
  for (const PlannedCarry& carry : repeat.carries) {
    visit(-1, carry.start, nullptr);
    visit(-1, carry.next, nullptr);
  }
  for (const PlannedCondition& condition : repeat.conditions) {
    Wire wire;
    wire.step = condition.step;
    wire.output = condition.output;
    visit(-1, wire, nullptr);
  }
  for (const PlannedItem& inner : repeat.body) visit_wires(plan, inner, visit);
}

void visit_steps(const Plan& plan, const std::vector<PlannedItem>& items, int repeat,
                 const std::function<void(int step, int repeat)>& visit) {
  for (const PlannedItem& item : items) {
    if (item.step >= 0)
      visit(item.step, repeat);
    else
      visit_steps(plan, plan.repeats[item.repeat].body, item.repeat, visit);
  }
}

}  // namespace

std::vector<std::size_t> last_uses(const Plan& plan) {
  std::vector<std::size_t> last(plan.steps.size(), 0);
  for (std::size_t place = 0; place < plan.order.size(); ++place) {
    visit_steps(plan, {plan.order[place]}, -1,
                [&](int step, int) { last[step] = std::max(last[step], place); });
    visit_wires(plan, plan.order[place], [&](int, const Wire& wire, const InputDescription*) {
      if (wire.step >= 0) last[wire.step] = std::max(last[wire.step], place);
    });
  }
  // What passes through lives as long as the one that draws on it: go back from consumers to
  // producers.
  const auto keeping = keeping_of(plan);
  for (std::size_t place = plan.order.size(); place-- > 0;)
    visit_wires(plan, plan.order[place], [&](int step, const Wire& wire, const InputDescription*) {
      if (step >= 0 && wire.step >= 0 && keeping[step] == Keeping::passing)
        last[wire.step] = std::max(last[wire.step], last[step]);
    });
  return last;
}

std::vector<Keeping> keeping_of(const Plan& plan) {
  std::vector<int> repeat_of(plan.steps.size(), -1);
  std::map<std::string, int> uses;
  visit_steps(plan, plan.order, -1, [&](int step, int repeat) {
    repeat_of[step] = repeat;
    ++uses[plan.steps[step].description->name];
  });
  std::vector<int> wires(plan.steps.size(), 0), passable(plan.steps.size(), 0);
  for (const PlannedItem& item : plan.order)
    visit_wires(plan, item, [&](int step, const Wire& wire, const InputDescription* port) {
      if (wire.step < 0) return;
      ++wires[wire.step];
      passable[wire.step] +=
          step >= 0 && port->access == Access::item && repeat_of[step] == repeat_of[wire.step] &&
          plan.steps[step].description->items == plan.steps[wire.step].description->items;
    });
  std::vector<Keeping> keeping;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const StepDescription& step = *plan.steps[s].description;
    const bool transient = step.items && step.items->transient;
    const bool large = step.items && step.outputs.size() == 1 && step.outputs.front().type->large;
    if (transient || (large && wires[s] == 1 && passable[s] == 1))
      keeping.push_back(Keeping::passing);
    else if (repeat_of[s] >= 0 || uses[step.name] > 1)
      keeping.push_back(Keeping::remembered);
    else
      keeping.push_back(Keeping::kept);
  }
  return keeping;
}

}  // namespace plumb
