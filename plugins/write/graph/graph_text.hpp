#pragma once
/// A pose graph as a g2o file.

#include <optional>
#include <string>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::write_graph {

/// The relative pose that an edge's pairs say, fitted from `T_i_j` on, and its information: J'J /
/// sigma^2, J the derivative of the pairs' residuals by g2o's [t; q.vec]. sigma [m] is `noise`, or
/// without it the rms that is left after the fit (over the degrees of freedom, at least 1 mm).
/// Nothing for fewer than 3 pairs.
std::optional<RelativePose> constraint_of(const Edge& edge, const Matches& matches,
                                          const Pose& T_i_j, std::optional<double> noise);

/// VERTEX_SE3:QUAT, FIX of the first vertex, EDGE_SE3:QUAT for each constraint; VERTEX_SE2 and
/// EDGE_SE2 where `constraints.planar`. Vertices have the numbers of `constraints.ids`, or count
/// from 0 if it is empty. Numbers are the shortest that read back as the same.
std::string g2o_text(const Poses& poses, const Constraints& constraints);

}  // namespace plumb::write_graph
