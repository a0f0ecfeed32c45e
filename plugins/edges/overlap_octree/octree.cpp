#include "octree.hpp"

#include <CGAL/Octree.h>

#include <utility>
#include <vector>

#include "shared/cgal/adapter.hpp"

namespace plumb::edges_overlap_octree {
namespace {

using Points = std::vector<cgal::Point>;
using Octree = CGAL::Octree<cgal::Kernel, Points>;

/// The root is the smallest cube round the points; two opposite corners make it that of the
/// lattice.
constexpr std::size_t corners = 2;

Points points_in(const Cloud& cloud, const Pose& T_world_segment,
                 const overlapping::Lattice& lattice) {
  const overlapping::Cells cells(T_world_segment, lattice);
  Points points;
  points.reserve(cloud.size() + corners);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3d cell = cells.of(cloud.point(k));
    if (overlapping::Cells::within(cell, lattice.bits)) points.push_back(cgal::point_of(cell));
  }
  const auto edge = static_cast<double>(1 << lattice.bits);
  points.emplace_back(0.0, 0.0, 0.0);
  points.emplace_back(edge, edge, edge);
  return points;
}

/// Of both nodes, which cover one cube: points in leaves that hold points of both.
std::size_t shared_points(const Octree::Node& a, const Octree::Node& b) {
  if (a.empty() || b.empty()) return 0;
  if (a.is_leaf()) return a.size() + b.size();  // both are cells
  std::size_t sum = 0;
  for (std::size_t child = 0; child < 8; ++child) sum += shared_points(a[child], b[child]);
  return sum;
}

}  // namespace

/// The octree refers to the points and puts them in its own order.
struct CloudOctree::Tree {
  Tree(Points in_cells, int bits)
      : points(std::move(in_cells)), octree(points, Octree::PointMap(), 1.0) {
    octree.refine(static_cast<std::size_t>(bits), 0);
  }
  Points points;
  Octree octree;
};

CloudOctree::CloudOctree(const Cloud& cloud, const Pose& T_world_segment,
                         const overlapping::Lattice& lattice)
    : tree_(std::make_unique<Tree>(points_in(cloud, T_world_segment, lattice), lattice.bits)) {}
CloudOctree::CloudOctree(CloudOctree&&) noexcept = default;
CloudOctree& CloudOctree::operator=(CloudOctree&&) noexcept = default;
CloudOctree::~CloudOctree() = default;

std::size_t CloudOctree::points() const { return tree_->points.size() - corners; }

double overlap(const CloudOctree& a, const CloudOctree& b) {
  if (a.points() == 0 || b.points() == 0) return 0;
  // Both have both corners, each in a leaf of its own.
  const std::size_t both =
      shared_points(a.tree_->octree.root(), b.tree_->octree.root()) - 2 * corners;
  return static_cast<double>(both) / static_cast<double>(a.points() + b.points());
}

}  // namespace plumb::edges_overlap_octree
