#pragma once
/// Which points of a cloud are described.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::describe_fpfh {

/// Of each cubic cell of edge `voxel_size` [m] the point nearest to the mean of the cell's points,
/// in ascending order of index. Points without a finite position or without a normal do not count.
/// Of two that are equally near the one with the lower index is taken.
std::vector<std::uint32_t> key_points(const Cloud& cloud, double voxel_size);

/// Every point that may be one, in ascending order of index.
std::vector<std::uint32_t> all_points(const Cloud& cloud);

}  // namespace plumb::describe_fpfh
