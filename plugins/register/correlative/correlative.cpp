#include "correlative.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::register_correlative {
namespace {

struct Places {
  std::vector<float> x, y;
};

Places within_range(const Cloud& cloud, double range) {
  Places near;
  const auto square = static_cast<float>(range * range);
  for (std::size_t k = 0; k < cloud.size(); ++k)
    if (cloud.x[k] * cloud.x[k] + cloud.y[k] * cloud.y[k] < square)
      near.x.push_back(cloud.x[k]), near.y.push_back(cloud.y[k]);
  return near;
}

}  // namespace

CorrelativeResult correlate(const Cloud& target, const Cloud& source, const PlanarPose& start,
                            const CorrelativeOptions& options) {
  CorrelativeResult result;
  result.T = start;
  const Places fixed = within_range(target, options.max_range),
               moving = within_range(source, options.max_range);
  if (fixed.x.empty() || moving.x.empty()) return result;

  const bool known = start.x != 0 || start.y != 0 || start.yaw != 0;
  const planar::Prior prior{start, known ? options.prior_weight : 0,
                            options.prior_translation_sigma, options.prior_rotation_sigma};

  // Where the peak is, to a cell.
  constexpr int levels = 5;
  const planar::LikelihoodField coarse(fixed.x, fixed.y, options.resolution, options.sigma,
                                       3 * options.sigma, levels);
  const double step = planar::yaw_step_for(moving.x, moving.y, options.resolution);
  auto peak = best_pose(
      coarse, moving.x, moving.y,
      {start, options.search_window, options.search_window, options.search_angle, prior}, step, 0);
  if (!peak || peak->score < options.retry_below) {
    result.retried = true;
    const auto wider =
        best_pose(coarse, moving.x, moving.y,
                  {start, options.retry_search_window, options.retry_search_window, M_PI, prior},
                  step, peak ? peak->score : 0);
    if (wider) peak = wider;
  }
  if (!peak) return result;
  result.score = score_of(coarse, moving.x, moving.y, peak->pose);  // without the prior

  const planar::LikelihoodField fine(fixed.x, fixed.y, options.fine_resolution, options.fine_sigma,
                                     3 * options.fine_sigma, 3);
  result.yaw_step =
      std::min(planar::yaw_step_for(moving.x, moving.y, options.fine_resolution), step);
  const double room = 1.2 * options.resolution;
  const auto best = best_pose(fine, moving.x, moving.y, {peak->pose, room, room, 1.5 * step, prior},
                              result.yaw_step, 0);
  result.T = best ? between_cells(fine, moving.x, moving.y, best->pose, result.yaw_step, prior)
                  : peak->pose;
  return result;
}

}  // namespace plumb::register_correlative
