#pragma once
/// From ranges to points: which way the beams look, where the laser sits, and which readings saw
/// nothing.

#include <optional>

#include "carmen_log.hpp"
#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb::source_carmen {

/// Beam k looks `start + k * step` [rad] to the left of straight ahead.
struct Fan {
  double start = 0, step = 0;
  bool known =
      true;  ///< false: nothing in the log says so, and the number of beams is of no known scanner
  bool operator==(const Fan&) const = default;
};

/// The log's own angles; else CARMEN's convention for FLASER: from -90 degrees in steps of 1 degree
/// (180 or 181 beams), half a degree (360, 361) or a quarter (720, 721); 540, 541, 1080, 1081 beams
/// are 270 degrees; any other number is 180 degrees from end to end, and not known. With
/// `field_of_view` [rad] the beams are spread over it from end to end.
Fan fan_of(const LaserScan& scan, std::optional<double> field_of_view);

/// From which reading on [m] a beam saw nothing, found from all readings: see the page. None where
/// no reading sticks out.
std::optional<double> repeated_maximum(const std::vector<LaserScan>& scans);

/// What counts as seen: low <= range < high [m].
struct Limits {
  double low = 0, high = 0;
};

/// How many readings were left out of a cloud.
struct LeftOut {
  std::size_t nothing_seen = 0, too_near = 0, no_number = 0;
};

/// The points seen, in the order of the beams, z = 0; adds to `left_out` if given.
Cloud cloud_of(const LaserScan& scan, const Fan& fan, const Limits& limits,
               LeftOut* left_out = nullptr);

/// T_robot_laser: the same in all scans within 5 mm and 0.1 degrees as the two poses of each say,
/// else `offset` [m] straight ahead (a log whose laser poses were corrected by a SLAM has a
/// different one each time).
Pose mounting_of(const std::vector<LaserScan>& scans, double offset);

}  // namespace plumb::source_carmen
