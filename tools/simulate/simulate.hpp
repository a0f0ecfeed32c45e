#pragma once
/// The simulator: a laser-SLAM sequence with exact truth, from a scene to a folder.

#include <filesystem>
#include <functional>

#include "plumb/slam/trajectory.hpp"
#include "simulate/scanner.hpp"
#include "simulate/scene.hpp"
#include "simulate/world.hpp"

namespace plumb::simulate {

/// Everything but the frames, which are scanned one by one from it.
struct Stage {
  Scene scene;  ///< settled
  Trajectory truth;
  Trajectory odometry;
  World world;
  Scanner scanner;

  Cloud frame(std::size_t k) const { return scanner.scan(world, truth.T_world_frame[k], k); }
};

/// Drives the path, builds the city along it and lets the odometry drift. Throws Error as settled,
/// drive and read_tum do.
Stage set_up(const Scene& scene);

/// What was written.
struct Summary {
  std::size_t frames = 0;
  std::size_t points = 0;
  std::size_t bytes = 0;
  double length = 0;      ///< of the true path [m]
  double drift = 0;       ///< drift_of the odometry [m]
  std::string unsettled;  ///< what OutputFolder::finish said
};

/// Writes frames/000000.pcd..., odometry.tum, truth.tum and scene.yaml into `folder`, beside it
/// first and then renamed, on `threads` threads (0: as many as there are cores), with the same
/// bytes for any number of them. `progress` is told, from one thread at a time, how many frames are
/// done. Throws Error, leaving nothing behind, where `folder` holds something that is not the
/// simulator's, or cannot be written.
Summary simulate(const Scene& scene, const std::filesystem::path& folder, int threads = 0,
                 const std::function<void(std::size_t done, std::size_t of)>& progress = {});

}  // namespace plumb::simulate
