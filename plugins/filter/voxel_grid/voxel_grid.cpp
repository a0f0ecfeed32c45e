#include "voxel_grid.hpp"

namespace plumb::filter_voxel_grid {

Thinned thin(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
             const std::vector<Eigen::Vector3f>& origins, double voxel_size) {
  thinning::VoxelMeans means(voxel_size);
  means.add(cloud, frame, origins);
  return means.take();
}

Thinned thin(const Segment& segment, double voxel_size) {
  return thin(segment.cloud, segment.frame, segment.range.origins(), voxel_size);
}

}  // namespace plumb::filter_voxel_grid
