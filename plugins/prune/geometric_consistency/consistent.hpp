#pragma once
/// The largest set of point pairs that keep the lengths between each other.

#include <cstdint>
#include <optional>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::prune_geometric_consistency {

struct ConsistencyOptions {
  double gc_size = 0.5;            ///< [m] by which the length between two pairs may differ
  std::uint32_t gc_threshold = 6;  ///< pairs that a set must have

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("gc_size", &ConsistencyOptions::gc_size)
        .unit("m")
        .range(0.001, 100)
        .source("PCL, whose default is 1 m")
        .doc(
            "two pairs are consistent if the distances between their points in either segment "
            "differ by no more; also the bound of the motion's inliers");
    is.param("gc_threshold", &ConsistencyOptions::gc_threshold)
        .range(3, 1e6)
        .source("PCL, whose default is 3")
        .doc("pairs that a consistent set must have; edges with fewer pairs are kept as they are");
  }
};

/// Indices of the pairs in the largest consistent set, ascending; of equally large ones the first.
/// Sets grow greedily: from the first pair that is in none yet, each next pair joins that is
/// consistent with all in the set; then RANSAC (with a fixed seed) keeps those that agree with one
/// motion. First is the pair whose points lie closest under `T_i_j`; without it, the first in
/// order. None if no set has gc_threshold pairs. Source: [Chen2007]; PCL's
/// GeometricConsistencyGrouping.
std::vector<std::uint32_t> largest_consistent(const Matches& matches,
                                              const std::optional<Pose>& T_i_j,
                                              const ConsistencyOptions& options);

}  // namespace plumb::prune_geometric_consistency
