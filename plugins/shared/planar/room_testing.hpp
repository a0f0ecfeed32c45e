#pragma once
/// For tests of registration in the plane: what a laser sees of walls, and a room.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "shared/planar/planar_pose.hpp"

namespace plumb::planar {

using Walls = std::vector<std::array<double, 4>>;  ///< x0 y0 x1 y1 of each [m]

/// How far the nearest wall is in the direction `heading` [rad] of the world, where `at` stands;
/// `range` [m] where none is nearer.
inline double distance_to(const Walls& walls, const PlanarPose& at, double heading, double range) {
  const double dx = std::cos(heading), dy = std::sin(heading);
  double nearest = range;
  for (const auto& w : walls) {
    const double ex = w[2] - w[0], ey = w[3] - w[1], det = ex * dy - ey * dx;
    if (std::abs(det) < 1e-12) continue;
    const double px = w[0] - at.x, py = w[1] - at.y;
    const double hit = (ex * py - ey * px) / det, along = (dx * py - dy * px) / det;
    if (hit > 0 && along >= 0 && along <= 1) nearest = std::min(nearest, hit);
  }
  return nearest;
}

/// A room of 8 m x 6 m with a recess, as a laser in it sees it: `beams` rays, noise [m].
template <class Points>
Points room_scan(const PlanarPose& at, int beams, double noise, unsigned seed) {
  static const Walls walls = {{-3, -2, 5, -2},  {5, -2, 5, 1},       {5, 1, 1.5, 1},
                              {1.5, 1, 1.5, 4}, {1.5, 4, -3, 4},     {-3, 4, -3, -2},
                              {-1, 2, -0.5, 2}, {-0.5, 2, -0.5, 2.4}};
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  Points cloud;
  for (int k = 0; k < beams; ++k) {
    const double angle = 2 * M_PI * k / beams;
    const double range =
        distance_to(walls, at, at.yaw + angle, 1e9) + (noise > 0 ? error(random) : 0);
    cloud.add({static_cast<float>(range * std::cos(angle)),
               static_cast<float>(range * std::sin(angle)), 0});
  }
  return cloud;
}

/// How far apart [m] two poses are.
inline double off(const PlanarPose& a, const PlanarPose& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace plumb::planar
