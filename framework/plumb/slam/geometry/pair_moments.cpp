#include "plumb/slam/geometry/pair_moments.hpp"

#include <Eigen/QR>

#include "plumb/slam/geometry/symmetric.hpp"

namespace plumb {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Vector13d PairReference::coordinates(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) const {
  Vector13d y;
  const Eigen::Matrix3d r0 = T_j_i.matrix();
  for (int d = 0; d < 3; ++d) y.segment<3>(3 * d) = (r.row(d) - r0.row(d)).transpose();
  // s - s0 = (R - R0) centre + (t - t0), which loses nothing where both are near.
  y.segment<3>(9) = (r - r0) * centre + (t - T_j_i.translation);
  y[12] = 1;
  return y;
}

Vector13d PairForm::residual(const Eigen::Matrix3d& r, const Eigen::Vector3d& t) const {
  return factor * about.coordinates(r, t);
}

Matrix13d PointPairSums::moments() const {
  Matrix13d m = Matrix13d::Zero();
  for (int d = 0; d < 3; ++d) {
    m.block<3, 3>(3 * d, 3 * d) = pp_.topLeftCorner<3, 3>();
    m.block<3, 1>(3 * d, 9 + d) = pp_.topRightCorner<3, 1>();
    m.block<1, 3>(9 + d, 3 * d) = pp_.topRightCorner<3, 1>().transpose();
    m(9 + d, 9 + d) = pp_(3, 3);
    m.block<3, 1>(3 * d, 12) = pd_.block<3, 1>(0, d);
    m.block<1, 3>(12, 3 * d) = pd_.block<3, 1>(0, d).transpose();
    m(9 + d, 12) = m(12, 9 + d) = pd_(3, d);
  }
  m(12, 12) = dd_;
  return m;
}

Matrix13d PlanePairSums::moments() const {
  Matrix13d m;
  m.topLeftCorner<12, 12>() = aa_;
  m.topRightCorner<12, 1>() = ae_;
  m.bottomLeftCorner<1, 12>() = ae_.transpose();
  m(12, 12) = ee_;
  return m;
}

Matrix13d factor_of(const Matrix13d& moments) {
  const Vector13d scale = moments.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector13d back = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Matrix13d scaled = back.asDiagonal() * moments * back.asDiagonal();
  const auto eigen = symmetric_eigen(scaled);
  const Vector13d root = eigen.values.cwiseMax(0.0).cwiseSqrt();
  return root.asDiagonal() * eigen.vectors.transpose() * scale.asDiagonal();
}

Eigen::Matrix<double, 13, 6> PairForm::jacobian(const Eigen::Matrix3d& r) const {
  Eigen::Matrix<double, 12, 6> dy = Eigen::Matrix<double, 12, 6>::Zero();
  dy.block<3, 3>(9, 0).setIdentity();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Matrix3d dr = r * cross_matrix(Eigen::Vector3d::Unit(k));
    for (int d = 0; d < 3; ++d) dy.block<3, 1>(3 * d, 3 + k) = dr.row(d).transpose();
    dy.block<3, 1>(9, 3 + k) = dr * about.centre;
  }
  return factor.leftCols<12>() * dy;
}

Pose fitted(const PairForm& form, int steps) {
  Pose T = form.about.T_j_i;
  for (int step = 0; step < steps; ++step) {
    // Step about the centre, where rotation and translation hardly depend on each other: t + v with
    // s = R centre + t.
    const Eigen::Matrix3d r = T.matrix();
    Eigen::Matrix<double, 13, 6> jacobian = form.jacobian(r);
    jacobian.rightCols<3>() += jacobian.leftCols<3>() * (r * cross_matrix(form.about.centre));
    const Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, 13, 6>> solver(jacobian);
    const Vector6d move = solver.solve(-form.residual(r, T.translation));
    const Eigen::Vector3d s = T * form.about.centre + move.head<3>();
    T.rotation = (T.rotation * exp_rotation(move.tail<3>())).normalized();
    T.translation = s - T.rotation * form.about.centre;
    if (move.head<3>().norm() < 1e-10 && move.tail<3>().norm() < 1e-12) break;
  }
  return T;
}

}  // namespace plumb
