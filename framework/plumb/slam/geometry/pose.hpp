#pragma once
/// Rigid motions in space. `T_a_b` maps coordinates of b to coordinates of a, so T_a_c = T_a_b *
/// T_b_c.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>

namespace plumb {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// One degree [rad], as in 15 * deg.
inline constexpr double deg = std::numbers::pi / 180;

/// An element of SE(3): a unit quaternion and a translation [m].
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Pose() = default;
  Pose(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) : rotation(q), translation(t) {}
  Pose(const Eigen::Matrix3d& r, const Eigen::Vector3d& t)
      : rotation(Eigen::Quaterniond(r).normalized()), translation(t) {}

  Pose inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * translation)};
  }
  Pose operator*(const Pose& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  Eigen::Matrix3d matrix() const { return rotation.toRotationMatrix(); }
};

/// Rotation angle of `pose` [rad], 0 to pi.
inline double angle(const Pose& pose) {
  return 2.0 * std::atan2(pose.rotation.vec().norm(), std::abs(pose.rotation.w()));
}

/// Rotation vector (axis times angle [rad]) of a unit quaternion, the shorter way round.
inline Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  if (sine < 1e-12) return 2.0 * v;
  return 2.0 * std::atan2(sine, sign * q.w()) / sine * v;
}

/// Unit quaternion of a rotation vector [rad]; the inverse of log_rotation.
inline Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& w) {
  const double theta = w.norm();
  const double factor = theta < 1e-9 ? 0.5 - theta * theta / 48.0 : std::sin(0.5 * theta) / theta;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * theta);
  q.vec() = factor * w;
  return q.normalized();
}

/// The pose a fraction `s` (0 to 1) of the way from `a` to `b`: linear in translation, slerp in
/// rotation.
inline Pose interpolate(const Pose& a, const Pose& b, double s) {
  return {a.rotation.slerp(s, b.rotation).normalized(),
          (1.0 - s) * a.translation + s * b.translation};
}

/// A rigid motion in single precision, for moving many points of one cloud.
struct Motion {
  Eigen::Matrix3f r;
  Eigen::Vector3f t;
  explicit Motion(const Pose& pose)
      : r(pose.matrix().cast<float>()), t(pose.translation.cast<float>()) {}
  Eigen::Vector3f operator*(const Eigen::Vector3f& p) const { return r * p + t; }
};

}  // namespace plumb
