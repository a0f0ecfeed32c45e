#pragma once
/// Finds points with too few others round them.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::filter_radius_outlier {

/// The indices, ascending, of the points that have at least `min_neighbours` others within `radius`
/// [m]. Points must be finite. Source: PCL's RadiusOutlierRemoval.
std::vector<std::uint32_t> not_alone(const Cloud& cloud, double radius,
                                     std::uint32_t min_neighbours);

}  // namespace plumb::filter_radius_outlier
