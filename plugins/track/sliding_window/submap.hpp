#pragma once
/// The newest scans of a window as one submap, and registration of a scan to it.

#include <deque>
#include <optional>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "shared/planar/correlative_search.hpp"
#include "shared/planar/icp.hpp"

namespace plumb::track_sliding_window {

using planar::IcpOptions;
using planar::IcpResult;
using planar::LikelihoodField;
using planar::PlanarPose;

struct SubmapOptions {
  std::uint32_t frames = 10;  ///< scans in the window
  std::optional<double> voxel_size =
      0.05;                         ///< [m] points so near to one that is kept become one with it
  double radius = 0.25;             ///< [m] of the neighbourhood that a normal is taken from
  double search_window = 0.6;       ///< [m] half width of a search
  double search_angle = 30 * deg;   ///< [rad] half width of a search in heading
  double lost_search_window = 1.5;  ///< [m] half width of a search in all headings
};

enum class Breadth { near, all_headings };

/// Holds up to `frames` scans [m, in the plane], each with its pose; scans are referred to and must
/// outlive the submap. The submap's points are in the newest scan's coordinates.
class Submap {
 public:
  explicit Submap(const SubmapOptions& options) : options_(options) {}

  bool empty() const { return scans_.empty(); }
  std::size_t size() const { return scans_.size(); }
  const PlanarPose& newest() const { return scans_.back().T_world_scan; }
  const Cloud& points() const { return cloud_; }
  void clear() { scans_.clear(); }
  /// The scan becomes the newest; the oldest goes when there are more than `frames`.
  /// `with_normals`: those of lines.
  void add(const Cloud& scan, const PlanarPose& T_world_scan, bool with_normals);

  /// Registers a scan by ICP with the initial guess `start`; both poses are T_world_scan. The
  /// submap must not be empty.
  IcpResult align(const Cloud& scan, const PlanarPose& start, const IcpOptions& options) const;
  /// How well a scan lies at `pose` [0 to 1], less what is lost for its distance from `start`: both
  /// T_world_scan. `known`: the start comes from odometry, and little off is far off.
  double score(const Cloud& scan, const PlanarPose& pose, const PlanarPose& start,
               bool known) const;
  /// The best pose of the window round `start`, if any, T_world_scan.
  std::optional<PlanarPose> search(const Cloud& scan, const PlanarPose& start, bool known,
                                   Breadth breadth) const;

 private:
  struct Member {
    const Cloud* scan;
    PlanarPose T_world_scan;
  };
  void stitch();
  const LikelihoodField& field() const;
  void find_normals();

  SubmapOptions options_;
  std::deque<Member> scans_;
  Cloud cloud_;
  std::optional<SearchTree> tree_;
  mutable std::optional<LikelihoodField> field_;  ///< made at the first search
};

}  // namespace plumb::track_sliding_window
