#pragma once
/// K-means in six dimensions, seeded by k-means++.

#include <cstdint>
#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb::prune_kmeans {

struct Clusters {
  std::vector<std::uint32_t> of;  ///< of each vector: its cluster
  std::vector<Vector6d> centres;
};

/// Parts `vectors` into at most `k` clusters: seeds drawn far from each other (k-means++), then
/// Lloyd's rounds until no vector changes its cluster, at most 100. A vector as near to two centres
/// belongs to the lower one; a cluster that has lost its last vector stays where it was. Fewer
/// clusters come out only when fewer vectors differ. The same `random` gives the same clusters.
/// Source: [Arthur2007], [Lloyd1982].
Clusters kmeans(const std::vector<Vector6d>& vectors, std::uint32_t k, Random random);

/// How a cluster's worth is told.
enum class Keep {
  largest,  ///< by the number of its vectors; of equals the tighter one
  densest,  ///< by number / (spread + min_spread)^2, the spread being the rms distance to its
            ///< centre
};

/// Indices of the vectors in the best cluster, in order; of equally good ones the lower. None for
/// no vectors. `min_spread` [the vectors' unit] is the spread below which clusters count as equally
/// tight. For `densest`, clusters of fewer than `min_pairs` vectors do not count, unless all are.
std::vector<std::uint32_t> best_cluster(const Clusters& clusters,
                                        const std::vector<Vector6d>& vectors, Keep keep,
                                        double min_spread, std::uint32_t min_pairs);

}  // namespace plumb::prune_kmeans
