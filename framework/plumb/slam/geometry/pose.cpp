#include "plumb/slam/geometry/pose.hpp"

#include <cmath>

namespace plumb {

Pose::Pose(const Eigen::Matrix3d& r, const Eigen::Vector3d& t)
    : rotation(Eigen::Quaterniond(r).normalized()), translation(t) {}

Pose Pose::inverse() const {
  const Eigen::Quaterniond back = rotation.conjugate();
  return {back, -(back * translation)};
}

Pose Pose::operator*(const Pose& other) const {
  return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
}

Eigen::Vector3d Pose::operator*(const Eigen::Vector3d& point) const {
  return rotation * point + translation;
}

Eigen::Matrix3d Pose::matrix() const { return rotation.toRotationMatrix(); }

double angle(const Pose& pose) {
  return 2.0 * std::atan2(pose.rotation.vec().norm(), std::abs(pose.rotation.w()));
}

Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  if (sine < 1e-12) return 2.0 * v;
  return 2.0 * std::atan2(sine, sign * q.w()) / sine * v;
}

Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& w) {
  const double theta = w.norm();
  const double factor = theta < 1e-9 ? 0.5 - theta * theta / 48.0 : std::sin(0.5 * theta) / theta;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * theta);
  q.vec() = factor * w;
  return q.normalized();
}

Pose interpolate(const Pose& a, const Pose& b, double s) {
  return {a.rotation.slerp(s, b.rotation).normalized(),
          (1.0 - s) * a.translation + s * b.translation};
}

Motion::Motion(const Pose& pose)
    : r(pose.matrix().cast<float>()), t(pose.translation.cast<float>()) {}

}  // namespace plumb
