#pragma once
/// Clouds in octrees of CGAL, and how much two of them overlap.

#include <memory>

#include "plumb/slam/segment.hpp"
#include "shared/overlapping/lattice.hpp"

namespace plumb::edges_overlap_octree {

/// The points of a segment in an octree over a lattice: the root is the cube of all its cells,
/// every node that holds a point is divided down to single cells. Points that lie in no cell are
/// left out.
class CloudOctree {
 public:
  CloudOctree(const Cloud& cloud, const Pose& T_world_segment, const overlapping::Lattice& lattice);
  CloudOctree(CloudOctree&&) noexcept;
  CloudOctree& operator=(CloudOctree&&) noexcept;
  ~CloudOctree();

  std::size_t points() const;

 private:
  friend double overlap(const CloudOctree& a, const CloudOctree& b);
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Points of both clouds in leaves that hold points of both / points of both, 0 to 1, by a descent
/// through both trees. They are over one lattice. Source: [Tang2024] 2.3.1.
double overlap(const CloudOctree& a, const CloudOctree& b);

}  // namespace plumb::edges_overlap_octree
