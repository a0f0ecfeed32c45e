#pragma once
/// The terms of the graph's cost, each with its derivatives by hand. Derivatives are by the moves
/// (v, w) of pose_manifold.hpp: (R exp(w), t + v), in the first six columns of a pose's block.
/// Every term's residual is multiplied by *root_weight.

#include <ceres/sized_cost_function.h>

#include "plumb/slam/geometry/pair_moments.hpp"
#include "plumb/slam/graph.hpp"

namespace plumb::solve_pose_graph {

/// All pairs of an edge (i, j) at once: |F y(T_j^-1 T_i)|^2 = sum w |T_i p - T_j q|^2, or with
/// planes sum w (n'(T_j^-1 T_i p - q))^2. `form` is read at each evaluation: it may change between
/// solves.
class PairCost final : public ceres::SizedCostFunction<13, 7, 7> {
 public:
  PairCost(const PairForm* form, const double* root_weight)
      : form_(form), root_weight_(root_weight) {}
  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  const PairForm* form_;
  const double* root_weight_;
};

/// ConstraintError::g2o (constraint_error.hpp).
class G2oCost final : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  G2oCost(const RelativePose& constraint, const double* root_weight);
  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  Pose T_j_i_;  ///< Z^-1
  Matrix6d root_;
  const double* root_weight_;
};

/// ConstraintError::chordal.
class ChordalCost final : public ceres::SizedCostFunction<12, 7, 7> {
 public:
  ChordalCost(const RelativePose& constraint, bool planar, const double* root_weight);
  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  Eigen::Matrix3d R_i_j_;
  Eigen::Vector3d t_i_j_;
  double root_tau_, root_kappa_;
  const double* root_weight_;
};

/// e'Omega e with e = [t; q.vec] of Z^-1 T_i.
class AbsolutePoseCost final : public ceres::SizedCostFunction<6, 7> {
 public:
  explicit AbsolutePoseCost(const AbsolutePose& measured);
  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  Pose T_i_world_;
  Matrix6d root_;
};

/// e'Omega e with e = T_i p_i - p_world.
class AbsolutePointCost final : public ceres::SizedCostFunction<3, 7> {
 public:
  explicit AbsolutePointCost(const AbsolutePoint& measured);
  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override;

 private:
  Eigen::Vector3d p_i_, p_world_;
  Eigen::Matrix3d root_;
};

/// A factor F with Omega = F'F, also of a matrix without full rank. Throws Error where an
/// eigenvalue is clearly negative.
Eigen::MatrixXd information_root(const Eigen::MatrixXd& information);

/// The two weights of the chordal error. In space tau = 3 / tr(Omega_t^-1), kappa = 3 / (2
/// tr(Omega_r^-1)); in the plane tau = 2 / tr(Omega_xy^-1), kappa = Omega_theta. Omega_r is that of
/// q.vec as the file gives it; a planar Omega has its angle's information in the last entry, times
/// 4 because q.vec is half the angle. Source: [Rosen2019], its reader of g2o files.
struct ChordalWeights {
  double tau, kappa;
};
ChordalWeights chordal_weights(const Matrix6d& information, bool planar);

}  // namespace plumb::solve_pose_graph
