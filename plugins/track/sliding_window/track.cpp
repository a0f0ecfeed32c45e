#include "track.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb::track_sliding_window {
namespace {

class Tracker {
 public:
  Tracker(std::span<const Cloud* const> scans, const Poses& initial, const TrackOptions& options)
      : scans_(scans),
        initial_(initial),
        options_(options),
        submap_(options),
        lines_(options.icp.metric == planar::Metric::line),
        poses_(scans.size()) {
    result_.poses = initial;
    const auto moved = [&](const Pose& pose) {
      return pose.translation != initial.T_world_segment[0].translation ||
             pose.rotation.coeffs() != initial.T_world_segment[0].rotation.coeffs();
    };
    has_odometry_ =
        std::any_of(initial.T_world_segment.begin(), initial.T_world_segment.end(), moved);
  }

  Tracked run(const Edges& chain) {
    if (chain.size() == 0) return std::move(result_);
    const std::uint32_t first = chain.list.front().i;
    place(first, planar::projected(initial_.T_world_segment[first]));
    submap_.add(*scans_[first], poses_[first], lines_);
    for (const Edge& edge : chain.list) {
      const bool fits = follow(edge);
      between(edge);
      take(edge, fits);
    }
    outside(first, chain.list.back().j);
    return std::move(result_);
  }

 private:
  /// Places scan j of the edge; whether it fits.
  bool follow(const Edge& edge) {
    const bool known = has_odometry_;
    const PlanarPose start =
        poses_[edge.i] * (known ? planar::projected(initial_.relative(edge.i, edge.j)) : motion_);
    IcpOptions icp = options_.icp;
    if (!known) icp.start_sigma.reset();
    const Cloud& scan = *scans_[edge.j];

    IcpResult found = submap_.align(scan, start, icp);
    std::uint32_t iterations = found.iterations;
    const auto search = [&](Breadth breadth) {
      const auto peak = submap_.search(scan, start, known, breadth);
      if (!peak) return;
      const IcpResult other = submap_.align(scan, *peak, icp);
      iterations += other.iterations;
      if (submap_.score(scan, other.T, start, known) > submap_.score(scan, found.T, start, known))
        found = other;
    };
    if (options_.search_below &&
        found.overlap < (known ? *options_.search_below
                               : std::max(*options_.search_below, options_.search_blind))) {
      ++result_.searched;
      search(Breadth::near);
      if (found.overlap < options_.min_overlap) search(Breadth::all_headings);
    }
    const bool fits = found.pairs >= 3 && found.overlap >= options_.min_overlap;
    ++result_.registered;
    result_.iterations += iterations, result_.mae += found.mae, result_.overlap += found.overlap;
    result_.unfit += !fits;
    place(edge.j, fits ? found.T : start);
    motion_ = poses_[edge.i].inverse() * poses_[edge.j];
    return fits;
  }

  /// Lets scan j of the edge into the window, or start a new one.
  void take(const Edge& edge, bool fits) {
    unfit_in_a_row_ = fits ? 0 : unfit_in_a_row_ + 1;
    if (edge.kind != EdgeKind::sequential || unfit_in_a_row_ > options_.patience) {
      submap_.clear();
      ++result_.restarts;
      unfit_in_a_row_ = 0;
    } else if (!fits || !far(poses_[edge.j])) {
      return;
    }
    submap_.add(*scans_[edge.j], poses_[edge.j], lines_);
  }

  bool far(const PlanarPose& pose) const {
    const PlanarPose from = submap_.newest();
    return std::hypot(pose.x - from.x, pose.y - from.y) > options_.min_translation ||
           std::abs(planar::wrapped(pose.yaw - from.yaw)) > options_.min_rotation;
  }

  void place(std::uint32_t k, PlanarPose pose) {
    pose.yaw = planar::wrapped(pose.yaw);
    poses_[k] = pose;
    result_.poses.T_world_segment[k] = in_space(pose);
  }
  /// Scans that the edge leaves out.
  void between(const Edge& edge) {
    auto& T = result_.poses.T_world_segment;
    for (std::uint32_t k = edge.i + 1; k < edge.j; ++k)
      T[k] = interpolate(T[edge.i], T[edge.j], static_cast<double>(k - edge.i) / (edge.j - edge.i));
  }
  /// Scans before and after the chain.
  void outside(std::uint32_t first, std::uint32_t last) {
    auto& T = result_.poses.T_world_segment;
    for (std::uint32_t k = 0; k < first; ++k) T[k] = T[first] * initial_.relative(first, k);
    for (std::size_t k = last + 1; k < T.size(); ++k) T[k] = T[last] * initial_.relative(last, k);
  }

  std::span<const Cloud* const> scans_;
  const Poses& initial_;
  const TrackOptions& options_;
  Submap submap_;
  bool lines_, has_odometry_ = true;
  std::vector<PlanarPose> poses_;
  PlanarPose motion_;  ///< between the last two
  std::uint32_t unfit_in_a_row_ = 0;
  Tracked result_;
};

}  // namespace

Tracked track(std::span<const Cloud* const> scans, const Poses& initial, const Edges& chain,
              const TrackOptions& options) {
  if (initial.size() != scans.size() || chain.segments != scans.size())
    throw Error("got " + counted(scans.size(), "scans") + ", " + counted(initial.size(), "poses") +
                " and a chain of " + std::to_string(chain.segments) +
                "; wire those of the same scans");
  for (std::size_t k = 0; k < chain.size(); ++k)
    if (chain.list[k].i >= chain.list[k].j || (k > 0 && chain.list[k].i != chain.list[k - 1].j))
      throw Error("edge " + std::to_string(k) + " joins scans " + std::to_string(chain.list[k].i) +
                  " and " + std::to_string(chain.list[k].j) +
                  ", which does not go on from the edge before it: wire a chain, as gate.distance "
                  "makes it");
  return Tracker(scans, initial, options).run(chain);
}

}  // namespace plumb::track_sliding_window
