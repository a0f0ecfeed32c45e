#pragma once
/// What the edges' disagreement with each other tells of their errors, and the poses' uncertainty
/// that follows from it.

#include "terms.hpp"

namespace plumb::solve_pose_graph {

/// The mean cost, by degree of freedom, that edges and constraints have above the best that each
/// could have alone: 1 where they disagree as much as their weights say.
double variance_factor(const Terms& terms, const parallel::Loop& parallel);

/// Adds to `result` how well each pose but the fixed ones is known, and the variance factor; or the
/// warning that a direction is free. Only in space.
void add_uncertainty(const Terms& terms, const GraphOptions& options,
                     const parallel::Loop& parallel, GraphResult& result);

}  // namespace plumb::solve_pose_graph
