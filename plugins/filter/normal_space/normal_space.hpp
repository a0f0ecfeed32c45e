#pragma once
/// Thins a cloud so that all directions of normals are there alike.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::filter_normal_space {

/// Indices, ascending, of `count` points with normals, all of them if there are no more. The cube
/// of directions is cut into bins^3 cells, and in turn one point is drawn at random from each cell
/// that still has some. The same seed gives the same points. Throws Error where the cloud has no
/// normals. Source: [Rusinkiewicz2001] 3.1; PCL's NormalSpaceSampling.
std::vector<std::uint32_t> alike_in_normals(const Cloud& cloud, std::size_t count,
                                            std::uint32_t bins, std::uint32_t seed);

}  // namespace plumb::filter_normal_space
