#pragma once
/// A robot that drives along corners and turns on the spot, and what its wheels count.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "shared/planar/planar_pose.hpp"

namespace plumb::simulate {

using planar::PlanarPose;

/// One entry a scan.
struct IndoorDrive {
  std::vector<double> stamps;  ///< [s], from 0
  std::vector<PlanarPose> poses;
  std::vector<char> turning;  ///< on the spot

  std::size_t size() const { return stamps.size(); }
};

struct IndoorDriveOptions {
  double speed = 0.2;      ///< along the path [m/s]
  double turn_rate = 0.1;  ///< on the spot [rad/s]
  double rate = 5;         ///< scans a second [Hz]
  std::uint64_t seed = 1;
};

/// Straight from corner to corner of `way` but for a slight weaving, which turns at most half as
/// fast as the turns on the spot.
IndoorDrive drive_indoors(const std::vector<Eigen::Vector2d>& way,
                          const IndoorDriveOptions& options);

/// Length of the path through the poses [m].
double way_length(const std::vector<PlanarPose>& poses);

/// Poses by the wheels: wrong scales of way and turn, a wheel that is smaller than the other, and
/// slip at random, all scaled by one factor so that the greatest position error is `drift` [m]. The
/// first pose is the true one. Throws Error where the drift cannot be reached.
std::vector<PlanarPose> wheel_odometry(const std::vector<PlanarPose>& truth, double drift,
                                       std::uint64_t seed);

struct LostScans {
  double in_turns = 0;  ///< share of the scans on the spot
  std::int64_t stretches =
      0;               ///< without any scan, one in each of so many equal parts of the drive
  double stretch = 0;  ///< length of each [s]
  std::uint64_t seed = 1;
};

/// Which scans are lost; never the first, nor any within 10 s of the begin and the end. Throws
/// Error where the drive is too short for the stretches.
std::vector<char> lost_scans(const IndoorDrive& drive, const LostScans& options);

}  // namespace plumb::simulate
