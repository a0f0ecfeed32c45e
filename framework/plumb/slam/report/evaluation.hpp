#pragma once
/// How good a straightened trajectory is, against the sequence's truth, before and after.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "plumb/slam/report/ghosting.hpp"
#include "plumb/slam/trajectory_error.hpp"

namespace plumb {

/// What is evaluated.
struct EvaluationInput {
  std::filesystem::path
      sequence;  ///< a folder with truth.tum, odometry.tum, and frames/ or frames.txt
  std::filesystem::path trajectory;  ///< the straightened one, TUM
  std::filesystem::path truth;       ///< TUM; sequence/truth.tum if empty
  bool clouds = false;               ///< ghosting too
};

/// The errors of one trajectory.
struct TrajectoryScore {
  std::size_t poses;  ///< that have a true pose
  AbsoluteError absolute;
  RelativeError relative;            ///< over 10 m of path
  std::optional<Ghosting> ghosting;  ///< if asked for and every true pose has an estimated one
};

struct Evaluation {
  std::size_t true_poses;
  std::optional<TrajectoryScore> before;  ///< of odometry.tum, if the sequence has it
  TrajectoryScore after;
};

/// Throws Error: a file that is missing or wrong, a trajectory none of whose stamps is in the truth
/// (to 2 ms), fewer frames than true poses.
Evaluation evaluate(const EvaluationInput& input);

/// {"before": {...}, "after": {...}}, each with poses, ate_rmse, ate_max, rpe_m, rpe_deg and, where
/// known, ghosting, ghosting_truth, pairs. A number that is not defined, such as RPE of a path
/// under 10 m, is null.
std::string evaluation_json(const Evaluation& evaluation);

/// The same as a table for people.
std::string evaluation_table(const Evaluation& evaluation);

}  // namespace plumb
