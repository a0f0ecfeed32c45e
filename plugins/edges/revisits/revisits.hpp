#pragma once
/// Edges between segments that came near each other on different visits.

#include "plumb/data/graph.hpp"

namespace plumb {

struct RevisitOptions {
  double distance = 2;       ///< [m] between two segments' places, at most
  double gap = 3;            ///< [m] of way between them, at least
  double turn_length = 0.3;  ///< [m/rad] a turn counts as so much way
};

/// For each segment j and each earlier visit one edge, to the nearest segment i of that visit. A
/// visit is a run of consecutive segments that all lie within `distance` of j and at least `gap` of
/// way before it. Kind neighbour; the score falls from 1 to 0 with the distance. By a grid over the
/// places: n log n, and the edges found.
Edges revisits(const Poses& poses, const RevisitOptions& options);

}  // namespace plumb
