#pragma once
/// Rigid motions in the plane z = 0, for 2-D lasers: SE(2) beside pose.hpp's SE(3).

#include <Eigen/Core>
#include <cmath>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb::planar {

/// An element of SE(2): a place [m] and a heading [rad].
struct PlanarPose {
  double x = 0, y = 0, yaw = 0;

  PlanarPose operator*(const PlanarPose& other) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {x + c * other.x - s * other.y, y + s * other.x + c * other.y, yaw + other.yaw};
  }
  Eigen::Vector2d operator*(const Eigen::Vector2d& point) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {c * point.x() - s * point.y() + x, s * point.x() + c * point.y() + y};
  }
  PlanarPose inverse() const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {-(c * x + s * y), -(c * y - s * x), -yaw};
  }
};

/// The angle [rad] brought to -pi .. pi.
inline double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

/// The part of a pose that lies in the plane: x, y and the heading of its x axis.
inline PlanarPose projected(const Pose& pose) {
  const auto& q = pose.rotation;
  return {pose.translation.x(), pose.translation.y(),
          std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()))};
}

/// The same motion in space; z, roll and pitch are 0.
inline Pose in_space(const PlanarPose& pose) {
  return {Eigen::Quaterniond(std::cos(0.5 * pose.yaw), 0, 0, std::sin(0.5 * pose.yaw)),
          Eigen::Vector3d(pose.x, pose.y, 0)};
}

}  // namespace plumb::planar
