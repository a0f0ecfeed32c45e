#include "growing.hpp"

#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set/Least_squares_plane_fit_region.h>
#include <CGAL/property_map.h>

#include <Eigen/Eigenvalues>
#include <numeric>
#include <utility>

#include "shared/cgal/adapter.hpp"

namespace plumb::segment_planes {
namespace {

using Item = std::pair<cgal::Point, cgal::Vector>;
using Items = std::vector<Item>;
using Region = std::vector<std::size_t>;

/// The points with a normal, what CGAL knows of them, and a tree over them.
struct Oriented {
  Cloud cloud;
  std::vector<std::uint32_t> index;  ///< in the segment
  Items items;
  SearchTree tree;

  explicit Oriented(const Cloud& all) : tree(Cloud()) {
    for (std::uint32_t k = 0; k < all.size(); ++k)
      if (all.point(k).allFinite() && all.normal(k).squaredNorm() > 0.5f) index.push_back(k);
    cloud = select(all, index);
    for (std::size_t k = 0; k < cloud.size(); ++k)
      items.emplace_back(cgal::point_of(cloud.point(k)), cgal::vector_of(cloud.normal(k)));
    tree = SearchTree(cloud);
  }
};

/// What CGAL calls a NeighborQuery.
class Neighbours {
 public:
  Neighbours(const Oriented& points, double radius)
      : points_(points), radius_(static_cast<float>(radius)) {}
  void operator()(std::size_t k, Region& neighbours) {
    points_.tree.within(points_.cloud.point(k), radius_, found_, true);
    neighbours.clear();
    for (const auto& neighbour : found_) neighbours.push_back(neighbour.index);
  }

 private:
  const Oriented& points_;
  float radius_;
  std::vector<SearchTree::Neighbour> found_;
};

/// What CGAL calls a SeedMap: the k-th point to begin with.
struct Seeds {
  const Region* order = nullptr;
  friend std::size_t get(const Seeds& seeds, std::size_t k) { return (*seeds.order)[k]; }
};

/// The points in order of how much their neighbours' normals differ from their own; those with
/// fewer than three others come last.
Region flattest_first(const Oriented& points, Neighbours& neighbours_of) {
  std::vector<double> bend(points.items.size(), 2);
  Region neighbours;
  for (std::size_t k = 0; k < bend.size(); ++k) {
    neighbours_of(k, neighbours);
    if (neighbours.size() < 4) continue;
    double sum = 0;
    for (const std::size_t other : neighbours)
      sum +=
          1 - std::abs(static_cast<double>(points.cloud.normal(k).dot(points.cloud.normal(other))));
    bend[k] = sum / static_cast<double>(neighbours.size());
  }
  Region order(bend.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return bend[k]; });
  return order;
}

std::vector<Region> regions_of(const Oriented& points, const GrowingOptions& options) {
  using PointMap = CGAL::First_of_pair_property_map<Item>;
  using NormalMap = CGAL::Second_of_pair_property_map<Item>;
  using PlaneFit =
      CGAL::Shape_detection::Point_set::Least_squares_plane_fit_region<cgal::Kernel, Items,
                                                                       PointMap, NormalMap>;
  Neighbours neighbours(points, options.radius);
  const Region order = flattest_first(points, neighbours);
  PlaneFit fit(points.items, options.max_plane_distance, options.max_normal_angle / deg,
               options.min_points);
  CGAL::Shape_detection::Region_growing<Items, Neighbours, PlaneFit, Seeds> growing(
      points.items, neighbours, fit, Seeds{&order});
  std::vector<Region> regions;
  growing.detect(std::back_inserter(regions));
  return regions;
}

Plane plane_of(const Segment& segment, const std::vector<std::uint32_t>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto k : points) mean += segment.cloud.point(k).cast<double>();
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto k : points) {
    const Eigen::Vector3d off = segment.cloud.point(k).cast<double>() - mean;
    covariance += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  std::size_t seen_from_behind = 0;
  for (const auto k : points)
    seen_from_behind += normal.dot((segment.origin(k) - segment.cloud.point(k)).cast<double>()) < 0;
  if (2 * seen_from_behind > points.size()) normal = -normal;
  const double variance =
      std::max(eigen.eigenvalues()[0], 0.0) / static_cast<double>(points.size());
  return {normal.cast<float>(), static_cast<float>(normal.dot(mean)), mean.cast<float>(),
          static_cast<float>(std::sqrt(variance)), static_cast<std::uint32_t>(points.size())};
}

}  // namespace

Planes grow_planes(const Segment& segment, const GrowingOptions& options) {
  Planes result;
  result.label.assign(segment.cloud.size(), 0);
  if (!segment.cloud.has_normals()) return result;
  const Oriented oriented(segment.cloud);
  if (oriented.items.empty()) return result;
  std::vector<std::vector<std::uint32_t>> regions;
  for (const Region& region : regions_of(oriented, options)) {
    auto& points = regions.emplace_back();
    for (const std::size_t k : region) points.push_back(oriented.index[k]);
    std::ranges::sort(points);
  }
  std::ranges::stable_sort(regions, [](const auto& a, const auto& b) {
    return a.size() != b.size() ? a.size() > b.size() : a.front() < b.front();
  });
  for (const auto& points : regions) {
    result.planes.push_back(plane_of(segment, points));
    for (const auto k : points) result.label[k] = static_cast<std::uint32_t>(result.planes.size());
  }
  return result;
}

}  // namespace plumb::segment_planes
