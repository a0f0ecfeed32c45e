#pragma once
/// Two scans, and how well a motion between them fits.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb::check_odometry {

struct ScanOptions {
  double voxel_size = 0.4;  ///< [m] to which scans are thinned
  double max_distance = 1;  ///< [m] points without a nearer one count as if they were so far off
  std::uint32_t max_points = 500;  ///< of the second scan, evenly chosen
  std::uint32_t iterations = 15;
};

/// A scan to compare others with: thinned, with a search tree; normals are estimated where they are
/// asked for.
class ScanTarget {
 public:
  ScanTarget(const Cloud& scan, const ScanOptions& options);
  ~ScanTarget();
  ScanTarget(ScanTarget&&) noexcept;

  /// Mean distance [m] of the points p of `source` to the plane at the nearest point of this scan
  /// under T_target_source, each at most max_distance. It does not see sliding along one plane (so
  /// the rings that a scanner draws on the ground do not speak for standing still), but every edge
  /// and pole.
  double misfit(const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source);
  /// Point-to-plane ICP from T_target_source.
  Pose aligned(const std::vector<Eigen::Vector3f>& source, Pose T_target_source);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Points of a scan to ask with: thinned and evenly chosen.
std::vector<Eigen::Vector3f> asked_points(const Cloud& scan, const ScanOptions& options);

}  // namespace plumb::check_odometry
