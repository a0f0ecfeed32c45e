#include "consistent.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb::loops_submap {

std::vector<RelativePose> supported(const std::vector<RelativePose>& loops, const Poses& poses,
                                    const SupportOptions& options) {
  if (options.min_support == 0) return loops;
  std::vector<double> path(poses.size(), 0);
  for (std::size_t k = 1; k < poses.size(); ++k)
    path[k] = path[k - 1] + poses.relative(k - 1, k).translation.norm();
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return loops[a].j < loops[b].j; });

  std::vector<std::uint32_t> support(loops.size(), 0);
  for (std::size_t m = 0; m < order.size(); ++m) {
    const RelativePose& a = loops[order[m]];
    for (std::size_t n = m + 1; n < order.size(); ++n) {
      const RelativePose& b = loops[order[n]];
      const double at_j = path[b.j] - path[a.j];
      if (at_j > options.within) break;
      const double at_i = std::abs(path[b.i] - path[a.i]);
      if (a.j == b.j || at_i > options.within) continue;
      const Pose circle =
          a.T_i_j * poses.relative(a.j, b.j) * b.T_i_j.inverse() * poses.relative(b.i, a.i);
      const double limit = options.max_disagreement + options.per_metre * (at_i + at_j);
      if (circle.translation.norm() > limit || angle(circle) > limit / 3) continue;
      ++support[order[m]], ++support[order[n]];
    }
  }
  std::vector<RelativePose> kept;
  for (std::size_t k = 0; k < loops.size(); ++k)
    if (support[k] >= options.min_support) kept.push_back(loops[k]);
  return kept;
}

}  // namespace plumb::loops_submap
