#pragma once
/// An octree's leaves without the tree: the occupied voxels of a cloud, as sorted Morton codes.

#include <cstdint>
#include <vector>

#include "shared/overlapping/lattice.hpp"

namespace plumb::edges_overlap {

using overlapping::Lattice;
using overlapping::lattice_over;
using overlapping::world_box;

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
