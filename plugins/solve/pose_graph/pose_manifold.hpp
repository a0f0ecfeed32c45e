#pragma once
/// Poses as Ceres sees them: 7 numbers (qx qy qz qw tx ty tz) that move by 6, or by 3 in the plane.

#include <ceres/manifold.h>

#include <algorithm>
#include <array>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb::solve_pose_graph {

using PoseBlock = std::array<double, 7>;

inline PoseBlock block_of(const Pose& p) {
  return {p.rotation.x(),    p.rotation.y(),    p.rotation.z(),   p.rotation.w(),
          p.translation.x(), p.translation.y(), p.translation.z()};
}
inline Pose pose_of(const double* b) {
  return {Eigen::Quaterniond(b[3], b[0], b[1], b[2]), Eigen::Vector3d(b[4], b[5], b[6])};
}

/// Moves a pose to (R exp(w), t + v); the move is (v, w), or (v_x, v_y, w_z) if planar.
///
/// Cost functions here give their derivatives by (v, w) directly, in the first six of the seven
/// columns that Ceres asks for, and PlusJacobian merely picks columns: the chain rule through the
/// quaternion's four numbers would add work and rounding only. So these cost functions and this
/// manifold belong together.
class PoseManifold final : public ceres::Manifold {
 public:
  explicit PoseManifold(bool planar) : planar_(planar) {}
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return planar_ ? 3 : 6; }

  bool Plus(const double* x, const double* move, double* moved) const override {
    Vector6d d = Vector6d::Zero();
    for (int k = 0; k < TangentSize(); ++k) d[column(k)] = move[k];
    const Pose from = pose_of(x);
    const PoseBlock to = block_of({(from.rotation * exp_rotation(d.tail<3>())).normalized(),
                                   Eigen::Vector3d(from.translation + d.head<3>())});
    std::copy(to.begin(), to.end(), moved);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    std::fill(jacobian, jacobian + 7 * TangentSize(), 0.0);
    for (int k = 0; k < TangentSize(); ++k) jacobian[column(k) * TangentSize() + k] = 1;
    return true;
  }
  bool Minus(const double* y, const double* x, double* move) const override {
    const Pose to = pose_of(y), from = pose_of(x);
    Vector6d d;
    d << to.translation - from.translation, log_rotation(from.rotation.conjugate() * to.rotation);
    for (int k = 0; k < TangentSize(); ++k) move[k] = d[column(k)];
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    std::fill(jacobian, jacobian + 7 * TangentSize(), 0.0);
    for (int k = 0; k < TangentSize(); ++k) jacobian[k * 7 + column(k)] = 1;
    return true;
  }

 private:
  int column(int k) const { return planar_ && k == 2 ? 5 : k; }
  bool planar_;
};

}  // namespace plumb::solve_pose_graph
