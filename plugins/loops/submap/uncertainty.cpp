#include "uncertainty.hpp"

#include <limits>
#include <queue>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb::loops_submap {

Paths::Paths(const Poses& poses, const Constraints* loops, double turn_length, double loop_length)
    : travelled_(poses.size(), 0), steps_(poses.size()) {
  const auto join = [&](std::uint32_t i, std::uint32_t j, double length) {
    steps_[i].push_back({j, length});
    steps_[j].push_back({i, length});
  };
  for (std::uint32_t k = 1; k < poses.size(); ++k) {
    const Pose step = poses.relative(k - 1, k);
    const double length = step.translation.norm() + turn_length * angle(step);
    travelled_[k] = travelled_[k - 1] + length;
    join(k - 1, k, length);
  }
  if (!loops) return;
  for (const auto& loop : loops->relative) {
    if (loop.i >= poses.size() || loop.j >= poses.size())
      throw Error("a loop names segment " + std::to_string(std::max(loop.i, loop.j)) +
                  ", but got " + counted(poses.size(), "poses") +
                  ": wire loops of the same segments");
    join(loop.i, loop.j, loop_length);
  }
}

std::vector<double> Paths::from(std::size_t segment) const {
  std::vector<double> path(steps_.size(), std::numeric_limits<double>::infinity());
  using Item = std::pair<double, std::uint32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  path[segment] = 0;
  open.emplace(0, segment);
  while (!open.empty()) {
    const auto [length, at] = open.top();
    open.pop();
    if (length > path[at]) continue;
    for (const auto& step : steps_[at])
      if (const double next = length + step.length; next < path[step.to]) {
        path[step.to] = next;
        open.emplace(next, step.to);
      }
  }
  return path;
}

}  // namespace plumb::loops_submap
