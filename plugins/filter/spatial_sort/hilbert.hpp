#pragma once
/// The order of points along a curve that fills space.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::filter_spatial_sort {

/// The indices of all points of `cloud` in the order of CGAL's Hilbert curve, which is divided at
/// medians: neighbours on it are neighbours in space. Points with a non-finite coordinate come
/// last, as they stood. The same points give the same order.
std::vector<std::uint32_t> hilbert_order(const Cloud& cloud);

}  // namespace plumb::filter_spatial_sort
