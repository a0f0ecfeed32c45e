#include "plumb/slam/geometry/symmetric.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace plumb {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(m);
  return {eigen.eigenvalues(), eigen.eigenvectors(), eigen.info() == Eigen::Success};
}

Vector6d solve_symmetric(const Matrix6d& m, const Vector6d& b) { return m.ldlt().solve(b); }

Matrix6d inverse_of_symmetric(const Matrix6d& m) { return m.ldlt().solve(Matrix6d::Identity()); }

}  // namespace plumb
