#pragma once
/// MulRan's laser scans: files named by their stamp, and where the laser stood then.

#include <filesystem>
#include <vector>

#include "plumb/slam/io/frame_files.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb::source_mulran {

/// A scan's file and its stamp [s].
struct Scan {
  io::FrameFile file;
  double stamp;
};

/// The scans Ouster/*.bin of `folder`, or *.bin where it has no folder Ouster, in order of their
/// stamps. Throws Error: no such folder, no scan, a name that is no stamp in nanoseconds, two scans
/// of the same time.
std::vector<Scan> scans_of(const std::filesystem::path& folder);

/// Scans with a pose each, and how many were left out.
struct PlacedScans {
  std::vector<Scan> scans;
  Trajectory trajectory;
  std::size_t outside = 0;  ///< before the first pose or after the last one
  std::size_t in_gap = 0;   ///< between poses farther apart than allowed
};

/// The pose of each scan, interpolated between the poses before and after it, which may be
/// `max_time_gap` [s] apart; scans that have no such poses are left out.
PlacedScans placed(const std::vector<Scan>& scans, const Trajectory& trajectory,
                   double max_time_gap);

/// T_vehicle_laser of MulRan's car. Source: [Kim2020], the data set's calibration of its Ouster
/// OS1-64.
Pose mulran_laser_on_vehicle();

}  // namespace plumb::source_mulran
