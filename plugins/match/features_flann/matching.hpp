#pragma once
/// Mutual nearest neighbours by an index that may miss some, and how many it missed.

#include "index.hpp"
#include "shared/feature_space/paired.hpp"

namespace plumb::match_features_flann {

struct Matching {
  feature_space::Pairs pairs;  ///< in ascending order of the first
  /// Of a sample of the first set's vectors: how many were compared with all of the second, and
  /// for how many of them the index had found one as near as the nearest.
  std::uint32_t sampled = 0, exact = 0;
};

/// Pairs (i, j) such that the index finds b_j for a_i, and a_i for b_j again. `recall_sample` of
/// the vectors of `a`, evenly chosen, are looked for exactly as well; distances that differ by less
/// than the rounding of FLANN's sums count as equal.
Matching match(std::span<const float> a, std::span<const float> b, std::size_t dimension,
               const IndexOptions& options, std::uint32_t recall_sample, std::uint64_t seed);

}  // namespace plumb::match_features_flann
