#pragma once
/// PCL's structures of space, as twins in benchmarks. Apart from our code for the reason that
/// pcl_twins.hpp gives.

#include <cstddef>
#include <memory>
#include <vector>

namespace plumb::twins {

/// A cloud in PCL's form with what PCL can build over it.
class PclSpace {
 public:
  PclSpace(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z);
  ~PclSpace();

  /// VoxelGrid: how many points are left.
  std::size_t voxel_grid(float leaf) const;

  /// Builds an OctreePointCloudPointVector with leaves of edge `size` [m], in place of the one
  /// before.
  void build_octree(double size);
  /// How many points of `other` lie in occupied leaves.
  std::size_t occupied_by(const PclSpace& other) const;

  /// Builds a KdTreeFLANN, in place of the one before.
  void build_tree();
  /// How many points of `other` have a neighbour at most `max` [m] away: the nearest of each is
  /// sought.
  std::size_t near_to(const PclSpace& other, float max) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace plumb::twins
