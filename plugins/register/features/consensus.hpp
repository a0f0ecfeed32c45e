#pragma once
/// The rigid motion that most point pairs agree on, found by the lengths between pairs alone,
/// without drawing at random.

#include <cstdint>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::register_features {

struct ConsensusOptions {
  double tolerance =
      0.6;  ///< [m] two pairs are compatible when | |p_a - p_b| - |q_a - q_b| | is at most this
  double min_length =
      4;  ///< [m] between two points, below which two pairs say nothing of each other
  std::uint32_t max_pairs = 1500;  ///< evenly chosen of more; the time goes with the square
  std::uint32_t seeds =
      60;  ///< pairs with the most compatible ones, from each of which a motion is built
};

struct Consensus {
  Pose T_j_i;
  std::vector<std::uint32_t> inliers;  ///< pairs with |T_j_i p - q| <= tolerance, in order; fewer
                                       ///< than three: there is no motion
};

/// Rigid motions keep lengths, so right pairs are compatible with each other and wrong ones by
/// chance only. From each of the most compatible pairs the pairs are taken that share the most
/// compatible ones with it (second-order compatibility), a motion is fitted to them and fitted
/// again to who agrees; the motion with the most inliers wins, the first of equals. Source: Chen et
/// al. 2022 (SC2-PCR), without its learnt or spectral parts; Shi et al. 2021 (ROBIN).
Consensus consensus_of(const Matches& matches, const ConsensusOptions& options);

}  // namespace plumb::register_features
