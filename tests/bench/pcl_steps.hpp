#pragma once
/// The kernels of steps that call PCL, with their default options, for benchmarks beside ours. A
/// library of its own that shows nothing else: they were compiled without AVX, and no function of
/// Eigen's may be taken from the one side by the other (pcl_twins.hpp).

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/graph.hpp"

namespace plumb::twins {

#define PLUMB_SHOWN [[gnu::visibility("default")]]

// Of a cloud, with normals but for GASD and radius_outlier: how many keypoints, numbers or points
// they give.
PLUMB_SHOWN std::size_t iss(const Cloud& cloud);
PLUMB_SHOWN std::size_t harris3d(const Cloud& cloud);
PLUMB_SHOWN std::size_t shot(const Cloud& cloud, const std::vector<std::uint32_t>& keys);
PLUMB_SHOWN std::size_t vfh(const Cloud& cloud);
PLUMB_SHOWN std::size_t gasd(const Cloud& cloud);
PLUMB_SHOWN std::size_t radius_outlier(const Cloud& cloud, double radius,
                                       std::uint32_t min_neighbours);
PLUMB_SHOWN std::size_t covariance_sampling(const Cloud& cloud, std::size_t count);
PLUMB_SHOWN std::size_t normal_space(const Cloud& cloud, std::size_t count);

// Of pairs, under the identity: those that are kept.
PLUMB_SHOWN std::vector<std::uint32_t> geometric_consistency(const Matches& matches);
PLUMB_SHOWN std::vector<std::uint32_t> hough(const Matches& matches);
PLUMB_SHOWN std::vector<std::uint32_t> one_to_one(const Matches& matches);

// Of two clouds, from T_i_j: iterations.
PLUMB_SHOWN std::uint32_t gicp(const Cloud& i, const Cloud& j, const Pose& T_i_j);
PLUMB_SHOWN std::uint32_t ndt(const Cloud& i, const Cloud& j, const Pose& T_i_j);

#undef PLUMB_SHOWN

}  // namespace plumb::twins
