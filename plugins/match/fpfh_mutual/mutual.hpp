#pragma once
/// Mutual nearest neighbours between two sets of vectors, exactly.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace plumb::match_fpfh_mutual {

/// Pairs (i, j) such that b_j is the nearest to a_i among all b, and a_i the nearest to b_j among
/// all a; in ascending order of i. `a` and `b` hold one vector of length `dimension` after the
/// other. Distances are compared as sums of squared differences in double; of equally near vectors
/// the one with the lower index is nearest. Vectors with a component that is non-finite, or
/// whose squared length fits no float, have no neighbours.
std::vector<std::pair<std::uint32_t, std::uint32_t>> mutual_nearest(std::span<const float> a,
                                                                    std::span<const float> b,
                                                                    std::size_t dimension);

/// The same by comparing all pairs one by one: what it means, and its judge.
std::vector<std::pair<std::uint32_t, std::uint32_t>> mutual_nearest_plainly(
    std::span<const float> a, std::span<const float> b, std::size_t dimension);

}  // namespace plumb::match_fpfh_mutual
