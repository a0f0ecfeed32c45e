#pragma once
/// Motions of a robot on a floor.

#include <cmath>
#include <numbers>

#include "plumb/geometry/pose.hpp"

namespace plumb::simulate {

/// Where a robot stands [m] and looks [rad, against the clock from x].
struct Planar {
  double x = 0, y = 0, heading = 0;

  Pose pose() const {
    return {Eigen::Quaterniond(std::cos(0.5 * heading), 0, 0, std::sin(0.5 * heading)),
            Eigen::Vector3d(x, y, 0)};
  }
};

/// The same angle within -pi to pi.
inline double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

}  // namespace plumb::simulate
