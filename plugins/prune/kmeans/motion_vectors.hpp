#pragma once
/// For each point pair, a vector that says which motion it implies.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::prune_kmeans {

/// What p - T_i_j q is, in i's coordinates [m]; the last three numbers are 0. Pairs that imply the
/// same translation have the same.
std::vector<Vector6d> displacements(const Matches& matches, const Pose& T_i_j);

/// The displacement, and the smallest rotation that turns q's normal onto p's, as a rotation vector
/// [rad] times `lever` [m]. Throws Error when there are pairs without normals.
std::vector<Vector6d> motions(const Matches& matches, const Pose& T_i_j, double lever);

}  // namespace plumb::prune_kmeans
