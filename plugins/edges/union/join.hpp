#pragma once
/// One graph from several lists of edges.

#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::edges_union {

/// All edges of `lists`, ordered by (i, j), each pair once: the first list to name a pair decides
/// on kind and score. Throws Error when the lists are of different numbers of segments.
Edges joined(const std::vector<const Edges*>& lists);

}  // namespace plumb::edges_union
