#include "costs.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/slam/geometry/symmetric.hpp"
#include "pose_manifold.hpp"

namespace plumb::solve_pose_graph {
namespace {

/// A pose block's derivative: rows x 7, of which the last column is 0.
template <int rows>
using Jacobian = Eigen::Map<Eigen::Matrix<double, rows, 7, Eigen::RowMajor>>;

template <int rows, class Derivative>
void store(double* to, const Derivative& derivative) {
  Jacobian<rows> jacobian(to);
  jacobian.template leftCols<6>() = derivative;
  jacobian.col(6).setZero();
}

/// [t; q.vec] of a pose, with the sign of q that has q.w >= 0.
Vector6d g2o_vector(const Pose& e) {
  Vector6d v;
  v << e.translation, (e.rotation.w() < 0 ? -1.0 : 1.0) * e.rotation.vec();
  return v;
}

/// Derivative of q.vec (q.w >= 0) by w where q moves to q exp(w).
Eigen::Matrix3d vector_by_turn(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  return 0.5 * sign * (q.w() * Eigen::Matrix3d::Identity() + cross_matrix(q.vec()));
}

}  // namespace

bool PairCost::Evaluate(double const* const* poses, double* residuals, double** jacobians) const {
  const Pose T_i = pose_of(poses[0]), T_j = pose_of(poses[1]);
  const Eigen::Matrix3d R_i = T_i.matrix(), R_j = T_j.matrix(), R = R_j.transpose() * R_i;
  const Eigen::Vector3d t = R_j.transpose() * (T_i.translation - T_j.translation);
  const double weight = *root_weight_;
  Eigen::Map<Vector13d>(residuals, 13) = weight * form_->residual(R, t);
  if (!jacobians) return true;

  // T_j_i moves to (R exp(a), t + b): for a move (v, w) of T_i, a = w and b = R_j' v; for one of
  // T_j, a = -R' w and b = [t]x w - R_j' v.
  const Eigen::Matrix<double, 13, 6> by = weight * form_->jacobian(R);
  Eigen::Matrix<double, 13, 6> derivative;
  if (jacobians[0]) {
    derivative << by.leftCols<3>() * R_j.transpose(), by.rightCols<3>();
    store<13>(jacobians[0], derivative);
  }
  if (jacobians[1]) {
    derivative << -by.leftCols<3>() * R_j.transpose(),
        by.leftCols<3>() * cross_matrix(t) - by.rightCols<3>() * R.transpose();
    store<13>(jacobians[1], derivative);
  }
  return true;
}

G2oCost::G2oCost(const RelativePose& constraint, const double* root_weight)
    : T_j_i_(constraint.T_i_j.inverse()),
      root_(information_root(constraint.information)),
      root_weight_(root_weight) {}

bool G2oCost::Evaluate(double const* const* poses, double* residuals, double** jacobians) const {
  const Pose T_i = pose_of(poses[0]), T_j = pose_of(poses[1]);
  const Pose T_i_j = T_i.inverse() * T_j, error = T_j_i_ * T_i_j;
  const Matrix6d root = *root_weight_ * root_;
  Eigen::Map<Vector6d>(residuals, 6) = root * g2o_vector(error);
  if (!jacobians) return true;

  const Eigen::Matrix3d R_z = T_j_i_.matrix(), R_i_world = T_i.matrix().transpose();
  const Eigen::Matrix3d turn = vector_by_turn(error.rotation);
  Matrix6d derivative = Matrix6d::Zero();
  if (jacobians[0]) {
    derivative.topLeftCorner<3, 3>() = -R_z * R_i_world;
    derivative.topRightCorner<3, 3>() = R_z * cross_matrix(T_i_j.translation);
    derivative.bottomRightCorner<3, 3>() = -turn * T_i_j.matrix().transpose();
    store<6>(jacobians[0], root * derivative);
  }
  if (jacobians[1]) {
    derivative.topLeftCorner<3, 3>() = R_z * R_i_world;
    derivative.topRightCorner<3, 3>().setZero();
    derivative.bottomRightCorner<3, 3>() = turn;
    store<6>(jacobians[1], root * derivative);
  }
  return true;
}

ChordalCost::ChordalCost(const RelativePose& constraint, bool planar, const double* root_weight)
    : R_i_j_(constraint.T_i_j.matrix()),
      t_i_j_(constraint.T_i_j.translation),
      root_weight_(root_weight) {
  const auto weights = chordal_weights(constraint.information, planar);
  root_tau_ = std::sqrt(weights.tau);
  root_kappa_ = std::sqrt(weights.kappa);
}

bool ChordalCost::Evaluate(double const* const* poses, double* residuals,
                           double** jacobians) const {
  const Pose T_i = pose_of(poses[0]), T_j = pose_of(poses[1]);
  const Eigen::Matrix3d R_i = T_i.matrix(), R_j = T_j.matrix();
  const double tau = *root_weight_ * root_tau_, kappa = *root_weight_ * root_kappa_;
  Eigen::Map<Eigen::Vector3d>(residuals, 3) =
      tau * (T_j.translation - T_i.translation - R_i * t_i_j_);
  Eigen::Map<Eigen::Matrix3d>(residuals + 3) = kappa * (R_j - R_i * R_i_j_);
  if (!jacobians) return true;

  Eigen::Matrix<double, 12, 6> derivative = Eigen::Matrix<double, 12, 6>::Zero();
  for (int end = 0; end < 2; ++end) {
    if (!jacobians[end]) continue;
    const double sign = end == 0 ? -1 : 1;
    derivative.topLeftCorner<3, 3>() = sign * tau * Eigen::Matrix3d::Identity();
    if (end == 0)
      derivative.topRightCorner<3, 3>() = tau * R_i * cross_matrix(t_i_j_);
    else
      derivative.topRightCorner<3, 3>().setZero();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Matrix3d turn = cross_matrix(Eigen::Vector3d::Unit(k));
      const Eigen::Matrix3d by = end == 0 ? Eigen::Matrix3d(-kappa * R_i * turn * R_i_j_)
                                          : Eigen::Matrix3d(kappa * R_j * turn);
      derivative.block<9, 1>(3, 3 + k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(by.data());
    }
    store<12>(jacobians[end], derivative);
  }
  return true;
}

AbsolutePoseCost::AbsolutePoseCost(const AbsolutePose& measured)
    : T_i_world_(measured.T_world_i.inverse()), root_(information_root(measured.information)) {}

bool AbsolutePoseCost::Evaluate(double const* const* poses, double* residuals,
                                double** jacobians) const {
  const Pose error = T_i_world_ * pose_of(poses[0]);
  Eigen::Map<Vector6d>(residuals, 6) = root_ * g2o_vector(error);
  if (jacobians && jacobians[0]) {
    Matrix6d derivative = Matrix6d::Zero();
    derivative.topLeftCorner<3, 3>() = T_i_world_.matrix();
    derivative.bottomRightCorner<3, 3>() = vector_by_turn(error.rotation);
    store<6>(jacobians[0], root_ * derivative);
  }
  return true;
}

AbsolutePointCost::AbsolutePointCost(const AbsolutePoint& measured)
    : p_i_(measured.p_i),
      p_world_(measured.p_world),
      root_(information_root(measured.information)) {}

bool AbsolutePointCost::Evaluate(double const* const* poses, double* residuals,
                                 double** jacobians) const {
  const Pose T_i = pose_of(poses[0]);
  Eigen::Map<Eigen::Vector3d>(residuals, 3) = root_ * (T_i * p_i_ - p_world_);
  if (jacobians && jacobians[0]) {
    Eigen::Matrix<double, 3, 6> derivative;
    derivative << Eigen::Matrix3d::Identity(), -T_i.matrix() * cross_matrix(p_i_);
    store<3>(jacobians[0], root_ * derivative);
  }
  return true;
}

Eigen::MatrixXd information_root(const Eigen::MatrixXd& information) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(information);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixU();
  const auto eigen = symmetric_eigen(information);
  const Eigen::VectorXd& values = eigen.values;
  if (!(values.minCoeff() >= -1e-9 * values.cwiseAbs().maxCoeff()))
    throw Error("an information matrix has the negative eigenvalue " +
                short_number(values.minCoeff()) + "; it must be positive semidefinite");
  return values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.vectors.transpose();
}

ChordalWeights chordal_weights(const Matrix6d& information, bool planar) {
  if (planar)
    return {2 / information.topLeftCorner<2, 2>().inverse().trace(), information(5, 5) / 4};
  return {3 / information.topLeftCorner<3, 3>().inverse().trace(),
          3 / (2 * information.bottomRightCorner<3, 3>().inverse().trace())};
}

}  // namespace plumb::solve_pose_graph
