#pragma once
/// The rounds in which a graph is solved: weights from the present residuals, Levenberg-Marquardt
/// with these weights, and so on.

#include "terms.hpp"

namespace plumb::solve_pose_graph {

/// What the solution took.
struct Effort {
  int rounds = 0;
  int iterations = 0;  ///< of Levenberg-Marquardt, in all rounds
};

/// Moves the poses of `terms` to where the cost is least, from `start`, which they have on entry.
/// Weights are those of the final scales at the end. Throws Error where Ceres gives up.
Effort solve_in_rounds(const Poses& start, Terms& terms, const GraphOptions& options,
                       const parallel::Loop& parallel);

}  // namespace plumb::solve_pose_graph
