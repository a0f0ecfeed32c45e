#pragma once
/// Finds points whose mean distance to their neighbours is unusually large.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/search_tree.hpp"
#include "shared/parallel/loop.hpp"

namespace plumb::filter_statistical_outlier {

/// The mean distance [m] of each point to its `mean_k` nearest other points (all there are, if
/// fewer; 0 for a single point). `tree` holds the points of `cloud`, all of them finite. The result
/// does not depend on the number of threads.
std::vector<float> mean_distances(const Cloud& cloud, const SearchTree& tree, std::size_t mean_k,
                                  const parallel::Loop& parallel);

/// The indices k, rising, with values[k] <= mean + stddev_mul_thresh * sigma, where sigma is the
/// values' standard deviation (over n - 1). Sums are double, in a fixed order. Source:
/// [Rusu2008] 3.1, as in PCL.
std::vector<std::uint32_t> not_beyond(const std::vector<float>& values, double stddev_mul_thresh);

}  // namespace plumb::filter_statistical_outlier
