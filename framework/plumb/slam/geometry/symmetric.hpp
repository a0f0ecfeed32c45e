#pragma once
/// Decompositions of symmetric matrices, compiled once: Eigen's own take seconds to compile in each
/// file that uses them.

#include <Eigen/Core>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// M = vectors * diag(values) * vectors'. Where `converged` is false (M is not finite) the rest
/// means nothing.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< a column each, of length 1
  bool converged = false;
};

/// Of a symmetric matrix, of which the lower triangle is read.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& m);

/// x of M x = b, for a symmetric M (LDL', robust Cholesky), of which the lower triangle is read.
Vector6d solve_symmetric(const Matrix6d& m, const Vector6d& b);

/// The inverse of a symmetric M in the same way.
Matrix6d inverse_of_symmetric(const Matrix6d& m);

}  // namespace plumb
