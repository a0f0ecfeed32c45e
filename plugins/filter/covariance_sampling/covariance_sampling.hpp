#pragma once
/// Thins a cloud so that ICP on it is as stable as can be.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::filter_covariance_sampling {

/// Indices, ascending, of `count` points with normals, all of them if there are no more. Each point
/// p with the normal n fixes a motion by the row [p x n; n], p about the centroid, by the mean
/// distance from it. The six eigenvectors of the sum of the rows' products are the directions that
/// are fixed alike; one point after the other is taken, each time that which fixes most of the
/// direction that those taken so far fix least. Throws Error where the cloud has no normals.
/// Source: [Gelfand2003]; PCL's CovarianceSampling.
std::vector<std::uint32_t> stable_points(const Cloud& cloud, std::size_t count);

}  // namespace plumb::filter_covariance_sampling
