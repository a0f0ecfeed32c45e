#pragma once
/// Logs of CARMEN, as 2-D data sets are published: one message a line.
///
///   FLASER n [n ranges] laser_x laser_y laser_theta robot_x robot_y robot_theta stamp host
///   logger_stamp ROBOTLASER1 type start fov step max accuracy remission_mode n [n ranges] m [m
///   remissions]
///               laser_x ... robot_theta tv rv forward side axis stamp host logger_stamp
///   RAWLASER1 type start fov step max accuracy remission_mode n [n ranges] m [m remissions] stamp
///   host logger_stamp ODOM x y theta tv rv accel stamp host logger_stamp PARAM name value stamp
///   host logger_stamp
///
/// Metres, radians, seconds. The stamp is the third word from the end: true relations refer to it;
/// the last one counts from the logger's start. RLASER, ROBOTLASER2 and RAWLASER2 are a second
/// laser, at the robot's back.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "shared/parallel/loop.hpp"
#include "shared/planar/planar_pose.hpp"

namespace plumb::source_carmen {

using planar::PlanarPose;

/// One scan of the front laser, as it stands in the log.
struct LaserScan {
  double stamp = 0;
  std::optional<PlanarPose> laser,
      robot;                   ///< by odometry; none in RAWLASER1 until given by ODOM lines
  double start = 0, step = 0;  ///< [rad], counter-clockwise; step 0: the log does not say
  double maximum = 0;          ///< [m]; 0: the log does not say
  std::vector<float> ranges;   ///< [m]; may hold NaN
};

struct CarmenLog {
  std::vector<LaserScan> scans;    ///< in the order of the file
  std::size_t odometry_lines = 0;  ///< ODOM
  std::size_t second_laser = 0;    ///< scans of another laser, left out
  std::size_t repeated = 0;        ///< the same laser's scans in another kind of message, left out
  std::size_t no_message = 0;      ///< lines that begin with no name of a message, left out
  std::size_t cut = 0;  ///< messages with fewer or more words than they announce, left out
  std::size_t not_numbers =
      0;  ///< messages with a word that should be a number and is none, left out
  std::size_t first_damaged =
      0;  ///< line of the first message left out for its damage, from 1; 0: none
  double front_laser_offset =
      0;  ///< PARAM robot_frontlaser_offset: the laser's place ahead of the robot's middle [m]
};

/// Reads the front laser's scans: FLASER lines, or where there are none ROBOTLASER1, or RAWLASER1
/// with poses interpolated between the ODOM lines round them. Damaged messages are left out and
/// counted. `file` is for sentences. Throws Error: no scan at all, or none that is whole.
CarmenLog parse_carmen(const std::filesystem::path& file, std::string_view text,
                       const parallel::Loop& parallel);

}  // namespace plumb::source_carmen
