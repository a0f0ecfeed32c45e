#pragma once
/// Clouds as PCL holds them: copies of plain floats. For the .cpp files of kernels that call PCL,
/// never for their headers, so that no type of PCL's and no block of memory that Eigen aligned
/// crosses from code without AVX to code with it.

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::pcl {

using Points = ::pcl::PointCloud<::pcl::PointXYZ>;
using Normals = ::pcl::PointCloud<::pcl::Normal>;

/// All points [m], in their order. Steps do not print: from the first cloud on PCL is silent.
Points::Ptr points_of(const Cloud& cloud);
Points::Ptr points_of(const std::vector<Eigen::Vector3f>& points);

/// The points of a cloud that have a normal, and which they are.
struct Oriented {
  Points::Ptr points;
  Normals::Ptr normals;
  std::vector<std::uint32_t> index;  ///< of each point in the cloud, ascending

  std::size_t size() const { return index.size(); }
};

/// Points without a normal, (0, 0, 0), are as if absent. Throws Error where none can have one: the
/// cloud has points, but no normals.
Oriented oriented(const Cloud& cloud);

}  // namespace plumb::pcl
