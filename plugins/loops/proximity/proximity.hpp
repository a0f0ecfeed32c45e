#pragma once
/// Edges between segments that came near each other on different visits.

#include "plumb/slam/graph.hpp"

namespace plumb::loops_proximity {

struct ProximityOptions {
  double max_distance = 2;         ///< [m] between two segments' places, at most
  double min_path_separation = 3;  ///< [m] of path between them, at least
  double turn_length = 0.3;        ///< [m/rad] path length that a rotation counts as
};

/// For each segment j and each earlier visit one edge, to the nearest segment i of that visit. A
/// visit is a run of consecutive segments that all lie within `max_distance` of j and at least
/// `min_path_separation` of path before it. Kind neighbour; the score falls from 1 to 0 with the
/// distance. By a grid over the places: n log n, and the edges found.
Edges revisits(const Poses& poses, const ProximityOptions& options);

}  // namespace plumb::loops_proximity
