#include "plumb/engine/plan/depth.hpp"

#include <algorithm>

#include "plumb/engine/plan/wires.hpp"

namespace plumb {
namespace {

/// Each item of a level stands behind those that it draws on, which are before it in the order.
void measure(const Plan& plan, const std::vector<PlannedItem>& level, Depths& depths) {
  std::vector<int> depth_at(plan.steps.size(), 0);  // of the item that a step is or is in, if any
  for (const PlannedItem& item : level) {
    int depth = 1;
    visit_wires(plan, item, [&](int, const Wire& wire, const InputDescription*) {
      if (wire.step >= 0) depth = std::max(depth, depth_at[wire.step] + 1);
    });
    visit_steps(plan, {item}, -1, [&](int step, int) { depth_at[step] = depth; });
    if (item.step >= 0) {
      depths.steps[item.step] = depth;
    } else {
      depths.repeats[item.repeat] = depth;
      measure(plan, plan.repeats[item.repeat].body, depths);
    }
  }
}

}  // namespace

Depths depths_of(const Plan& plan) {
  Depths depths{std::vector<int>(plan.steps.size()), std::vector<int>(plan.repeats.size())};
  measure(plan, plan.order, depths);
  return depths;
}

}  // namespace plumb
