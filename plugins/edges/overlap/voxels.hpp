#pragma once
/// An octree's leaves without the tree: the occupied voxels of a cloud, as sorted Morton codes.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "plumb/slam/segment.hpp"

namespace plumb::edges_overlap {

/// Cubic voxels of edge `size` [m] in world coordinates: voxel (0, 0, 0) begins at `origin` [m], a
/// whole multiple of `size`.
struct Lattice {
  double size = 1;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int bits = 21;  ///< codes of the cells that matter have 3 * bits bits
};

/// The smallest world box [m] round `box`, which is in the segment's coordinates; in double, for
/// world coordinates can be large.
Eigen::AlignedBox3d world_box(const Box& box, const Pose& T_world_segment);

/// The lattice that holds all `boxes`. Throws Error when that takes more than 2^21 voxels along an
/// axis.
Lattice lattice_over(const std::vector<Eigen::AlignedBox3d>& boxes, double size);

/// The Morton code of a voxel: bits of x, y, z in turn, so that code >> 3 is that of the octree's
/// next coarser voxel.
std::uint64_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// The occupied voxels of one cloud in Morton order, and those of the octree three levels up.
struct Voxels {
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> counts;  ///< points in each
  std::vector<std::uint64_t> coarse;  ///< codes of the voxels of edge 8 * size
  /// Where each coarse voxel's fine ones begin; one entry more, the end.
  std::vector<std::uint32_t> coarse_begin;
  std::vector<std::uint32_t> coarse_counts;  ///< points in each
  std::uint64_t points = 0;
};

Voxels voxels_of(const Cloud& cloud, const Pose& T_world_segment, const Lattice& lattice);

/// Points of both clouds in voxels that hold points of both / points of both, 0 to 1. Time goes
/// with the number of voxels. Where the coarse voxels show that the overlap cannot be above
/// `least`, 0 comes back without a look at the fine ones. Source: [Tang2024] 2.3.1; that both
/// clouds share one lattice is ours.
double overlap(const Voxels& a, const Voxels& b, double least = 0);

}  // namespace plumb::edges_overlap
