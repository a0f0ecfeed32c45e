#pragma once
/// Which point pairs lie inside both clouds, away from where these end.

#include <cstdint>
#include <vector>

#include "plumb/slam/values.hpp"

namespace plumb::prune_edge_points {

/// Indices of the pairs with neither point at its cloud's border, in order.
/// Throws Error when there are pairs but no border marks.
std::vector<std::uint32_t> inner(const Matches& matches);

/// Indices of the pairs with neither point within `distance` [m] of an edge point of its own cloud,
/// in order. The edge points of a cloud are those of its features that are marked at_border. With
/// distance 0 and the features that the pairs were matched by, these are the pairs without marks.
/// Throws Error when there are features but no border marks.
std::vector<std::uint32_t> inner(const Matches& matches, const Features& of_i, const Features& of_j,
                                 double distance);

}  // namespace plumb::prune_edge_points
