#pragma once
/// A map of occupied cells that any number of points can be added to, in little memory.

#include <array>
#include <cstdint>
#include <vector>

#include "plumb/data/cloud.hpp"
#include "plumb/geometry/pose.hpp"

namespace plumb {

/// One occupied cell: where it is, how many points it has had, and the sum of their places inside it. 24 bytes.
///
/// A place inside is counted in 65536ths of the cell's edge (1.5 um at 0.1 m), so sums are whole numbers: the mean does not depend on
/// the order of the points, and nothing is lost far from the origin. After 65535 points a cell takes no more.
struct Voxel {
  std::uint64_t key = 0;  ///< 21 bits an axis, shifted to be positive; 0 is no cell
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> sum{};
};

/// A hash table of voxels with open addressing. Grows by half, so it is 57 to 85 % full.
class VoxelTable {
 public:
  explicit VoxelTable(std::size_t capacity = 64) : slots_(capacity) {}
  /// Adds the voxel's points to the cell that it names.
  void add(const Voxel& voxel);
  /// Brings the place of a cell into the cache.
  void prefetch(std::uint64_t key) const;
  std::size_t size() const { return used_; }
  const std::vector<Voxel>& slots() const { return slots_; }  ///< empty ones have key 0

 private:
  void grow();
  std::vector<Voxel> slots_;
  std::size_t used_ = 0;
};

class VoxelMap {
 public:
  static constexpr std::size_t shards = 64;  ///< parts that are filled independently

  /// Cells of edge length `leaf` [m], counted from `origin` [m, world].
  VoxelMap(double leaf, const Eigen::Vector3d& origin) : leaf_(leaf), origin_(origin), tables_(shards) {}

  /// A frame's cells, ordered by shard; `first[s]` is the first one of shard s, first[shards] the number of cells.
  struct Cells {
    std::vector<Voxel> voxels;
    std::array<std::uint32_t, shards + 1> first{};
    std::uint64_t too_far = 0;  ///< points more than a million cells from the origin, left out
  };
  /// The cells of a cloud under its pose. Safe from several threads.
  Cells cells_of(const Cloud& cloud, const Pose& T_world_cloud) const;

  /// Adds one shard of a frame's cells. Different shards may be filled at the same time; the result depends on each shard's order alone.
  void add(const Cells& cells, std::size_t shard);

  std::size_t size() const;
  /// The mean of each cell, relative to the origin [m], in an order that depends on the additions alone. Frees the cells as it goes.
  Cloud take();

 private:
  double leaf_;
  Eigen::Vector3d origin_;
  std::vector<VoxelTable> tables_;
};

}  // namespace plumb
