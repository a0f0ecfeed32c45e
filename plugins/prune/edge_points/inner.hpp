#pragma once
/// Which point pairs lie inside both clouds, away from where these end.

#include <cstdint>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::prune_edge_points {

/// Indices of the pairs with neither point at its cloud's border, in order.
/// Throws Error when there are pairs but no border marks.
std::vector<std::uint32_t> inner(const Matches& matches);

}  // namespace plumb::prune_edge_points
