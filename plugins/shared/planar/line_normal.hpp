#pragma once
/// The normal of a wall that a 2-D laser saw.

#include <Eigen/Core>
#include <cstddef>

namespace plumb::planar {

/// The unit normal, with z = 0 and up to sign, of the line that fits the points' x and y best.
/// Zero if there are fewer than 3, or if they make no line: across it they spread more than
/// 0.4 times as far (standard deviations) as along it, as at a corner or in clutter.
Eigen::Vector3f line_normal(const Eigen::Vector3f* points, std::size_t count);

}  // namespace plumb::planar
