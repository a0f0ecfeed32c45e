#include "plumb/engine/plan/depth.hpp"

#include <algorithm>

#include "plumb/engine/plan/level.hpp"

namespace plumb {
namespace {

/// Each item of a level stands behind those that it waits for, which are before it in the order.
void measure(const Plan& plan, const std::vector<PlannedItem>& items, Depths& depths) {
  const Level level = level_of(plan, items);
  std::vector<int> depth(items.size(), 1);
  for (std::size_t k = 0; k < items.size(); ++k) {
    for (const std::size_t earlier : level.before[k])
      depth[k] = std::max(depth[k], depth[earlier] + 1);
    if (items[k].step >= 0) {
      depths.steps[items[k].step] = depth[k];
    } else {
      depths.repeats[items[k].repeat] = depth[k];
      measure(plan, plan.repeats[items[k].repeat].body, depths);
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
