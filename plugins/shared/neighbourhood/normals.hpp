#pragma once
/// Normals of a cloud from the neighbours of each of its points.

#include <functional>

#include "plumb/plugin/context.hpp"
#include "shared/neighbourhood/finder.hpp"

namespace plumb::neighbourhood {

/// The unit normal at a point whose neighbours, as seen from it, are given; zero where it has none.
using NormalOf = std::function<Eigen::Vector3f(const std::vector<Eigen::Vector3f>& neighbours)>;

/// Writes nx, ny, nz of `cloud`: what `normal_of` says, turned to the half space of `origin(k)`,
/// where the sensor stood when it saw point k [m]; (0, 0, 0) where there is none. `tree` holds the
/// cloud's points. `normal_of` is asked from several threads; the result does not depend on their
/// number. Returns how many points have no normal.
std::size_t write_normals(Cloud& cloud, const SearchTree& tree, const Bounds& bounds,
                          const std::function<Eigen::Vector3f(std::size_t)>& origin,
                          Context& context, const NormalOf& normal_of);

/// The unit normal of the plane that fits `points` best in the sense of least squares, up to sign;
/// zero if there are fewer than 3. Of the standard deviations along the points' three axes the
/// middle one must be more than `min_width` of the greatest, else they are a line, and the least at
/// most `max_thickness` of the middle one, else they are no surface: then it is zero, too.
/// Coordinates should be small (taken from a point nearby), so that the sums keep their digits.
Eigen::Vector3f plane_normal(const Eigen::Vector3f* points, std::size_t count,
                             double min_width = 1e-3, double max_thickness = 1);

}  // namespace plumb::neighbourhood
