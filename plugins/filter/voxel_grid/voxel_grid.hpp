#pragma once
/// Thins a cloud to one point per occupied cubic cell.

#include "plumb/slam/segment.hpp"
#include "shared/thinning/voxel_means.hpp"

namespace plumb::filter_voxel_grid {

using Thinned = thinning::VoxelMeans::Result;

/// The means of VoxelMeans, of one cloud. `voxel_size` [m]; point k was seen by frame[k] (empty:
/// none is given, and none comes out), whose sensor stood at origins[frame[k]]. Throws Error when
/// the cloud is wider than 2^21 cells along an axis.
Thinned thin(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
             const std::vector<Eigen::Vector3f>& origins, double voxel_size);

/// The same for a segment.
Thinned thin(const Segment& segment, double voxel_size);

}  // namespace plumb::filter_voxel_grid
