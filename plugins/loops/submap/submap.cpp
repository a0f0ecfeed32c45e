#include "submap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "consistent.hpp"
#include "shared/planar/correlative_search.hpp"
#include "uncertainty.hpp"

namespace plumb::loops_submap {
namespace {

using planar::PlanarPose;

/// Planar points, one a cell of edge length `cell`: its first. Those beyond `range` of the origin
/// are left out.
class Places {
 public:
  Places(double cell, double range) : per_metre_(1 / cell), square_(range * range) {}

  void add(const Cloud& cloud, const PlanarPose& T) {
    const double c = std::cos(T.yaw), s = std::sin(T.yaw);
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      const double px = T.x + c * cloud.x[k] - s * cloud.y[k],
                   py = T.y + s * cloud.x[k] + c * cloud.y[k];
      if (px * px + py * py > square_) continue;
      const auto column = static_cast<std::int64_t>(std::floor(px * per_metre_));
      const auto row = static_cast<std::int64_t>(std::floor(py * per_metre_));
      if (!taken_.emplace((column << 32) ^ (row & 0xffffffff), true).second) continue;
      x.push_back(static_cast<float>(px)), y.push_back(static_cast<float>(py));
    }
  }
  std::vector<float> x, y;

 private:
  double per_metre_, square_;
  std::unordered_map<std::int64_t, bool> taken_;
};

class LoopFinder {
 public:
  LoopFinder(const std::function<std::shared_ptr<const Segment>(std::size_t)>& open,
             const Poses& poses, const Constraints* known, const LoopOptions& options)
      : open_(open),
        options_(options),
        paths_(poses, known, options.turn_length, 2 * options.max_distance) {
    for (const auto& pose : poses.T_world_segment) poses_.push_back(planar::projected(pose));
  }

  /// The segments whose submaps are searched for.
  std::vector<std::uint32_t> asking() const {
    std::vector<std::uint32_t> list;
    double last = -options_.stride;
    for (std::uint32_t j = options_.submap_segments; j < poses_.size(); ++j)
      if (travelled(j) - last >= options_.stride) list.push_back(j), last = travelled(j);
    return list;
  }

  std::vector<RelativePose> ask(std::uint32_t j, LoopCounts& counts) const {
    std::vector<RelativePose> loops;
    const auto lengths = paths_.from(j);
    const auto places = visits(j, lengths);
    if (places.empty()) return loops;
    Places submap(2 * options_.resolution, options_.max_range);
    for (std::uint32_t k = j + 1 - std::min(j + 1, options_.submap_segments); k <= j; ++k)
      submap.add(open_(k)->cloud, poses_[j].inverse() * poses_[k]);
    if (submap.x.size() < 20) return loops;
    const double step = planar::yaw_step_for(submap.x, submap.y, options_.resolution);
    for (const auto i : places) {
      ++counts.tried;
      if (auto loop = align(submap, step, i, j, lengths[i], counts)) loops.push_back(*loop);
    }
    return loops;
  }

 private:
  double travelled(std::uint32_t k) const { return paths_.travelled()[k]; }
  double search_window(double length) const {
    return std::min(options_.max_search_window, 0.3 + options_.drift * length);
  }
  double search_angle(double length) const {
    return std::min(options_.max_search_angle, 0.05 + options_.heading_drift * length);
  }
  double distance(std::uint32_t i, std::uint32_t j) const {
    return std::hypot(poses_[i].x - poses_[j].x, poses_[i].y - poses_[j].y);
  }

  /// The nearest segment of each earlier visit, a visit being a stretch of path within the window
  /// and no longer than the map that the submap is registered to.
  std::vector<std::uint32_t> visits(std::uint32_t j, const std::vector<double>& lengths) const {
    std::vector<std::uint32_t> list;
    std::optional<std::uint32_t> nearest, last, first;
    const auto close = [&] {
      if (nearest) list.push_back(*nearest);
      nearest.reset(), first.reset();
    };
    for (std::uint32_t i = 0; i < j && travelled(j) - travelled(i) >= options_.min_path_separation;
         ++i) {
      if (distance(i, j) > options_.max_distance + search_window(lengths[i])) continue;
      if (last && travelled(i) - travelled(*last) > options_.max_distance) close();
      if (first && travelled(i) - travelled(*first) > 3 * options_.max_distance) close();
      if (!first) first = i;
      last = i;
      if (!nearest || distance(i, j) < distance(*nearest, j)) nearest = i;
    }
    close();
    std::stable_sort(list.begin(), list.end(),
                     [&](auto a, auto b) { return distance(a, j) < distance(b, j); });
    if (list.size() > options_.max_places) list.resize(options_.max_places);
    return list;
  }

  std::optional<RelativePose> align(const Places& submap, double step, std::uint32_t i,
                                    std::uint32_t j, double length, LoopCounts& counts) const {
    Places map(0.5 * options_.resolution, options_.max_range + options_.max_distance);
    const std::uint32_t from = i - std::min(i, options_.map_segments);
    for (std::uint32_t k = from; k <= i + options_.map_segments && k < j &&
                                 travelled(j) - travelled(k) >= 0.5 * options_.min_path_separation;
         ++k)
      map.add(open_(k)->cloud, poses_[i].inverse() * poses_[k]);
    if (map.x.size() < 20) return std::nullopt;
    const planar::LikelihoodField field(map.x, map.y, options_.resolution, options_.resolution,
                                        3 * options_.resolution, 6);
    const planar::SearchWindow window{poses_[i].inverse() * poses_[j], search_window(length),
                                      search_window(length), search_angle(length)};
    const auto peak = best_pose(field, submap.x, submap.y, window, step, options_.min_score);
    if (!peak) return ++counts.low, std::nullopt;
    if (best_pose(field, submap.x, submap.y, window, step, options_.max_second_peak * peak->score,
                  planar::Excluded{peak->pose, options_.min_peak_distance, 0.25}))
      return ++counts.ambiguous, std::nullopt;
    const PlanarPose T = between_cells(field, submap.x, submap.y, peak->pose, step);
    RelativePose loop{i, j, in_space(T), Matrix6d::Zero()};
    // Half a cell as standard deviation; a constraint's rotation is a quaternion's vector, half the
    // angle.
    const double place = std::pow(0.5 * options_.resolution, -2),
                 heading = 4 * std::pow(0.5 * step, -2);
    loop.information.diagonal() << place, place, 0, 0, 0, heading;
    return loop;
  }

  const std::function<std::shared_ptr<const Segment>(std::size_t)>& open_;
  const LoopOptions& options_;
  Paths paths_;
  std::vector<PlanarPose> poses_;
};

}  // namespace

Loops find_loops(const std::function<std::shared_ptr<const Segment>(std::size_t)>& open,
                 const Poses& poses, const Constraints* known, const LoopOptions& options,
                 Context& context) {
  const LoopFinder finder(open, poses, known, options);
  const auto asking = finder.asking();
  std::vector<std::vector<RelativePose>> found(asking.size());
  std::vector<LoopCounts> counts(asking.size());
  context.parallel(asking.size(),
                   [&](std::size_t k) { found[k] = finder.ask(asking[k], counts[k]); });
  Loops result;
  result.constraints.planar = true;
  result.counts.asked = static_cast<std::uint32_t>(asking.size());
  for (std::size_t k = 0; k < asking.size(); ++k) {
    result.constraints.relative.insert(result.constraints.relative.end(), found[k].begin(),
                                       found[k].end());
    result.counts.tried += counts[k].tried;
    result.counts.low += counts[k].low;
    result.counts.ambiguous += counts[k].ambiguous;
  }
  const auto before = result.constraints.relative.size();
  result.constraints.relative =
      supported(result.constraints.relative, poses,
                {options.min_support, 10, options.max_disagreement, 0.02});
  result.counts.alone = static_cast<std::uint32_t>(before - result.constraints.relative.size());
  return result;
}

}  // namespace plumb::loops_submap
