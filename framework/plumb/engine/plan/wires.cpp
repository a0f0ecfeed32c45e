#include "plumb/engine/plan/wires.hpp"

namespace plumb {

void visit_wires(const Plan& plan, const PlannedItem& item, const VisitWire& visit) {
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
                 const VisitStep& visit) {
  for (const PlannedItem& item : items) {
    if (item.step >= 0)
      visit(item.step, repeat);
    else
      visit_steps(plan, plan.repeats[item.repeat].body, item.repeat, visit);
  }
}

}  // namespace plumb
