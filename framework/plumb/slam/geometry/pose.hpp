#pragma once
/// Rigid motions in space. `T_a_b` maps coordinates of b to coordinates of a, so T_a_c = T_a_b *
/// T_b_c.
///
/// Functions in these headers whose bodies are expressions of Eigen stand in a .cpp: the compiler
/// would work each of them out anew in every file that reads the header, used or not.

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
  Eigen::Quaterniond rotation{1, 0, 0, 0};
  Eigen::Vector3d translation{0, 0, 0};

  Pose() = default;
  Pose(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) : rotation(q), translation(t) {}
  Pose(const Eigen::Matrix3d& r, const Eigen::Vector3d& t);

  Pose inverse() const;
  Pose operator*(const Pose& other) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const;
  Eigen::Matrix3d matrix() const;
};

/// Rotation angle of `pose` [rad], 0 to pi.
double angle(const Pose& pose);

/// Rotation vector (axis times angle [rad]) of a unit quaternion, the shorter way round.
Eigen::Vector3d log_rotation(const Eigen::Quaterniond& q);

/// Unit quaternion of a rotation vector [rad]; the inverse of log_rotation.
Eigen::Quaterniond exp_rotation(const Eigen::Vector3d& w);

/// The pose a fraction `s` (0 to 1) of the way from `a` to `b`: linear in translation, slerp in
/// rotation.
Pose interpolate(const Pose& a, const Pose& b, double s);

/// A rigid motion in single precision, for moving many points of one cloud.
struct Motion {
  Eigen::Matrix3f r;
  Eigen::Vector3f t;
  explicit Motion(const Pose& pose);
  Eigen::Vector3f operator*(const Eigen::Vector3f& p) const {
    const auto row = [&](int k) {
      return r(k, 0) * p.x() + (r(k, 1) * p.y() + r(k, 2) * p.z()) + t(k);
    };
    return {row(0), row(1), row(2)};
  }
};

}  // namespace plumb
