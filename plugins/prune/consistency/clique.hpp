#pragma once
/// A largest set of vertices that are all joined to each other.

#include <cstdint>
#include <vector>

#include "shared/point_pairs/bit_graph.hpp"

namespace plumb::prune_consistency {

struct Clique {
  std::vector<std::uint32_t> vertices;  ///< in order
  bool largest = true;                  ///< whether it is proved that no other is larger
};

/// Begins with the largest clique that grows greedily from a vertex, then branches where a
/// colouring of the candidates and the core numbers allow a larger one, at most `max_branches`
/// times; what was found by then is the result. Nothing is drawn: the same graph gives the same
/// clique. Beside the graph it holds at most another one and 4 n^2 bytes. Source: [SanSegundo2011];
/// cores as bounds, [Yang2021].
Clique largest_clique(const point_pairs::BitGraph& graph, std::uint64_t max_branches);

}  // namespace plumb::prune_consistency
