#include "plumb/slam/geometry/symmetric.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace plumb {

bool symmetric_eigen(int n, const double* m, double* values, double* vectors) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      Eigen::Map<const Eigen::MatrixXd>(m, n, n));
  Eigen::Map<Eigen::VectorXd>(values, n) = eigen.eigenvalues();
  Eigen::Map<Eigen::MatrixXd>(vectors, n, n) = eigen.eigenvectors();
  return eigen.info() == Eigen::Success;
}

Vector6d solve_symmetric(const Matrix6d& m, const Vector6d& b) { return m.ldlt().solve(b); }

Matrix6d inverse_of_symmetric(const Matrix6d& m) { return m.ldlt().solve(Matrix6d::Identity()); }

}  // namespace plumb
