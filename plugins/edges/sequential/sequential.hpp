#pragma once
/// Edges between segments that follow each other.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::edges_sequential {

/// Joins k and k+1 for every k, kind sequential, score 1. `positions` [m, world] is where each
/// segment's frame is; the distance between two of them becomes the edge's centroid_distance. None
/// or one position gives no edge.
Edges sequential_edges(const std::vector<Eigen::Vector3d>& positions);

}  // namespace plumb::edges_sequential
