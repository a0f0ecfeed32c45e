#include "pcl_space.hpp"

#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/octree/octree_pointcloud_pointvector.h>
#include <pcl/point_types.h>

#include <optional>

namespace plumb::twins {

using Octree = pcl::octree::OctreePointCloudPointVector<pcl::PointXYZ>;

struct PclSpace::Held {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points{new pcl::PointCloud<pcl::PointXYZ>};
  std::optional<Octree> octree;
  std::optional<pcl::KdTreeFLANN<pcl::PointXYZ>> tree;
};

PclSpace::PclSpace(const std::vector<float>& x, const std::vector<float>& y,
                   const std::vector<float>& z)
    : held_(new Held) {
  for (std::size_t k = 0; k < x.size(); ++k) held_->points->emplace_back(x[k], y[k], z[k]);
}

PclSpace::~PclSpace() = default;

std::size_t PclSpace::voxel_grid(float leaf) const {
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(held_->points);
  grid.setLeafSize(leaf, leaf, leaf);
  pcl::PointCloud<pcl::PointXYZ> thinned;
  grid.filter(thinned);
  return thinned.size();
}

void PclSpace::build_octree(double size) {
  held_->octree.emplace(size);
  held_->octree->setInputCloud(held_->points);
  held_->octree->addPointsFromInputCloud();
}

std::size_t PclSpace::occupied_by(const PclSpace& other) const {
  std::size_t n = 0;
  for (const auto& point : *other.held_->points) n += held_->octree->isVoxelOccupiedAtPoint(point);
  return n;
}

void PclSpace::build_tree() {
  held_->tree.emplace(false);
  held_->tree->setInputCloud(held_->points);
}

std::size_t PclSpace::near_to(const PclSpace& other, float max) const {
  std::size_t n = 0;
  std::vector<int> index(1);
  std::vector<float> squared(1);
  for (const auto& point : *other.held_->points)
    n += held_->tree->nearestKSearch(point, 1, index, squared) > 0 && squared[0] <= max * max;
  return n;
}

}  // namespace plumb::twins
