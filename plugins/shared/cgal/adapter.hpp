#pragma once
/// Clouds and Eigen's vectors as CGAL has them. Only headers of CGAL that are LGPL are included
/// here; which others a step includes says its page.

#include <CGAL/Simple_cartesian.h>

#include <Eigen/Core>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::cgal {

/// Coordinates in double, reckoned without exact predicates: what these steps ask of CGAL takes no
/// decision that rounding could make inconsistent.
using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

inline Point point_of(const Eigen::Vector3d& p) { return Point(p.x(), p.y(), p.z()); }
inline Point point_of(const Eigen::Vector3f& p) { return point_of(p.cast<double>().eval()); }
inline Vector vector_of(const Eigen::Vector3f& v) {
  return Vector(static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z()));
}
inline Eigen::Vector3d eigen_of(const Vector& v) { return {v.x(), v.y(), v.z()}; }

/// All points of a cloud, in their order.
inline std::vector<Point> points_of(const Cloud& cloud) {
  std::vector<Point> points;
  points.reserve(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k) points.push_back(point_of(cloud.point(k)));
  return points;
}

}  // namespace plumb::cgal
