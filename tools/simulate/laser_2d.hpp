#pragma once
/// A planar laser scanner among walls.

#include <cstdint>
#include <vector>

#include "shared/planar/planar_pose.hpp"
#include "simulate/floor_plan.hpp"

namespace plumb::simulate {

using planar::PlanarPose;

struct Laser2dOptions {
  double field_of_view = 4.71238898038469;  ///< [rad], the first beam to the last
  std::int64_t columns = 541;               ///< beams
  double range = 10;                        ///< [m]
  double noise = 0.01;                      ///< standard deviation of a range [m]
};

/// Beams lie evenly over the field of view, the first on the right, both ends included; over a full
/// circle the last lies one step before the first. Exact but for the noise: every beam is met with
/// every wall that its direction can meet.
class Laser2d {
 public:
  Laser2d(const Laser2dOptions& options, std::uint64_t seed);

  /// One range [m] a beam; the greatest range where nothing is hit nearer. `index` picks the noise.
  std::vector<double> scan(const std::vector<Wall>& walls, const PlanarPose& pose,
                           std::uint64_t index) const;
  /// The same without noise.
  std::vector<double> exact(const std::vector<Wall>& walls, const PlanarPose& pose) const;

  double first_angle() const { return first_; }  ///< of beam 0 from straight ahead [rad]
  double step() const { return step_; }          ///< from beam to beam [rad]

 private:
  Laser2dOptions options_;
  std::uint64_t seed_;
  double first_, step_;
};

/// Distance [m] along a ray of unit `direction` to the wall; infinite where it is missed.
double distance_to(const Wall& wall, const Eigen::Vector2d& origin,
                   const Eigen::Vector2d& direction);

}  // namespace plumb::simulate
