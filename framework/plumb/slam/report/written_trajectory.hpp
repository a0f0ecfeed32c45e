#pragma once
/// The trajectory that a run ends with, as it wrote it, and what is known of it.

#include <filesystem>
#include <optional>
#include <string>

#include "plumb/engine/run/runner.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb {

struct WrittenTrajectory {
  Trajectory trajectory;
  std::string prefix = {};            ///< of its errors' names: "error.fine."; empty: not measured
  std::filesystem::path truth = {};   ///< by which they are; empty: there is none
  double tolerance = 2e-3;            ///< [s] between associated stamps
  double delta = 10;                  ///< [m] over which the relative error is taken
  std::filesystem::path frames = {};  ///< the folder of its frames, as the sensor saw them; empty:
                                      ///< not one of source.sequence
  std::filesystem::path odometry = {};  ///< TUM, with a pose for each of those
};

/// The file of a step write.trajectory, in TUM's format: of the one that writes what the last label
/// of a measure.trajectory is wired to; else of the only one there is. None for no such file.
std::optional<WrittenTrajectory> written_trajectory(const Plan& plan, const RunResult& result);

}  // namespace plumb
