#pragma once
/// Normals of a cloud: the direction in which each point's neighbourhood is thinnest.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/search_tree.hpp"
#include "shared/neighbourhood/normals.hpp"

namespace plumb::estimate_normals {

/// Which points count as neighbours of a point, itself included: the `most` nearest of those within
/// `radius` [m]. Either may be left open, not both.
struct Neighbourhood {
  std::optional<double> radius;
  std::optional<std::uint32_t> most;
  /// Of the standard deviations along the neighbourhood's three axes: the middle one is at least
  /// this share of the greatest, else it is a line ...
  double min_width = 1e-3;
  double max_thickness =
      1;  ///< ... and the least at most this share of the middle one, else it is no surface
  bool planar =
      false;  ///< the cloud lies in a plane z = const: normals of lines in it, by line_normal
};

/// Writes nx, ny, nz of `cloud`: unit normals that point to the half space of `origin(k)`, where
/// the sensor stood when it saw point k [m]. A point with fewer than 3 neighbours, or whose
/// neighbours lie on one line or on no surface (see Neighbourhood), gets the normal (0, 0, 0).
/// `tree` holds the cloud's points. The result does not depend on the number of threads. Returns
/// how many points have no normal.
std::size_t estimate_normals(Cloud& cloud, const SearchTree& tree, const Neighbourhood& of,
                             const std::function<Eigen::Vector3f(std::size_t)>& origin,
                             Context& context);

using neighbourhood::plane_normal;

}  // namespace plumb::estimate_normals
