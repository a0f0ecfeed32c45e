#pragma once
/// The k-cores of a graph.

#include <vector>

#include "shared/point_pairs/bit_graph.hpp"

namespace plumb::prune_consistency {

/// Of each vertex the largest k such that it is in the k-core: the largest set in which each is
/// joined to at least k others. A clique of m vertices is in the (m - 1)-core. Time goes with the
/// number of joins. Source: [Batagelj2003].
std::vector<std::uint32_t> core_numbers(const point_pairs::BitGraph& graph);

/// The vertices with the greatest core number, in order.
std::vector<std::uint32_t> innermost_core(const point_pairs::BitGraph& graph);

}  // namespace plumb::prune_consistency
