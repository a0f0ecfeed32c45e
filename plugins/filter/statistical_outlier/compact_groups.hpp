#pragma once
/// Parts points into small groups of near ones.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::filter_statistical_outlier {

/// The indices of all points, ordered so that every `size` consecutive ones, from the first on, lie
/// close together: halved at the median along the widest axis, again and again, at multiples of
/// `size`. Only the last group may be smaller.
std::vector<std::uint32_t> compact_groups(const Cloud& cloud, std::size_t size);

}  // namespace plumb::filter_statistical_outlier
