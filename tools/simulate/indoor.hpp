#pragma once
/// The simulator indoors: a planar scanner's log with exact truth, from a scene to a folder.

#include <filesystem>
#include <functional>
#include <vector>

#include "plumb/slam/trajectory.hpp"
#include "simulate/building.hpp"
#include "simulate/indoor_drive.hpp"
#include "simulate/indoor_scene.hpp"
#include "simulate/laser_2d.hpp"

namespace plumb::simulate {

/// Everything but the scans, which are made one by one from it.
struct IndoorStage {
  IndoorScene scene;  ///< settled, with its drift
  Building building;
  IndoorDrive drive;
  std::vector<PlanarPose> odometry;  ///< one a pose of the drive
  std::vector<char> lost;            ///< the same
  Laser2d laser;

  std::vector<double> scan(std::size_t k) const {
    return laser.scan(building.walls, drive.poses[k], k);
  }
};

/// Builds, drives and lets the wheels drift. Throws Error as settled, wheel_odometry, lost_scans.
IndoorStage set_up(const IndoorScene& scene);

/// What was written.
struct IndoorSummary {
  std::size_t scans = 0, lost = 0, bytes = 0;
  double length = 0;      ///< of the true path [m]
  double drift = 0;       ///< greatest position error of the odometry [m]
  std::string unsettled;  ///< what OutputFolder::finish said
};

/// Writes into `folder`, beside it first and then renamed, with the same bytes for any number of
/// `threads` (0: as many as there are cores):
/// - log.clf: CARMEN's ODOM and ROBOTLASER1 lines, ranges to the millimetre, poses by the wheels;
///   the wheels go on where scans are lost
/// - truth.tum, odometry.tum: one pose a scan of the log, under its stamp; the laser sits on the
///   robot's axis
/// - plan.txt: the walls, a line each, `x1 y1 x2 y2` [m] in the coordinates of truth.tum
/// - scene.yaml: the scene that repeats it
/// `progress` is told, from one thread at a time, how many scans are done. Throws Error as
/// simulate() of a street does.
IndoorSummary simulate(const IndoorScene& scene, const std::filesystem::path& folder,
                       int threads = 0,
                       const std::function<void(std::size_t done, std::size_t of)>& progress = {});

}  // namespace plumb::simulate
