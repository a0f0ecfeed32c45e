#pragma once
/// For tests of what is found in graphs.

#include "plumb/data/random.hpp"
#include "shared/point_pairs/bit_graph.hpp"

namespace plumb::prune_consistency {

/// Any two vertices are joined with probability `share`.
inline point_pairs::BitGraph random_graph(std::size_t vertices, double share, std::uint64_t seed) {
  Random random(seed);
  point_pairs::BitGraph graph(vertices);
  for (std::size_t a = 0; a < vertices; ++a)
    for (std::size_t b = a + 1; b < vertices; ++b)
      if (random.uniform() < share) graph.join(a, b);
  return graph;
}

}  // namespace plumb::prune_consistency
