#include "shared/pcl/clouds.hpp"

#include <pcl/console/print.h>

#include "plumb/data/error.hpp"

namespace plumb::pcl {
namespace {

/// PCL tells of every point that it cannot describe, on standard error.
void silence() {
  static const bool once = [] {
    ::pcl::console::setVerbosityLevel(::pcl::console::L_ALWAYS);
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace

Points::Ptr points_of(const Cloud& cloud) {
  silence();
  Points::Ptr points(new Points);
  points->reserve(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k)
    points->emplace_back(cloud.x[k], cloud.y[k], cloud.z[k]);
  return points;
}

Points::Ptr points_of(const std::vector<Eigen::Vector3f>& points) {
  silence();
  Points::Ptr result(new Points);
  result->reserve(points.size());
  for (const auto& p : points) result->emplace_back(p.x(), p.y(), p.z());
  return result;
}

Oriented oriented(const Cloud& cloud) {
  silence();
  if (!cloud.empty() && !cloud.has_normals())
    throw Error("the segment has no normals: put estimate.normals before this step");
  Oriented result{Points::Ptr(new Points), Normals::Ptr(new Normals), {}};
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (cloud.normal(k).isZero()) continue;
    result.points->emplace_back(cloud.x[k], cloud.y[k], cloud.z[k]);
    result.normals->emplace_back(cloud.nx[k], cloud.ny[k], cloud.nz[k]);
    result.index.push_back(static_cast<std::uint32_t>(k));
  }
  return result;
}

}  // namespace plumb::pcl
