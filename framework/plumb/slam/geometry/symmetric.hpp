#pragma once
/// Decompositions of symmetric matrices, compiled once: Eigen's own take seconds to compile in each
/// file that uses them.

#include <Eigen/Core>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// M = vectors * diag(values) * vectors'. Where `converged` is false (M is not finite) the rest
/// means nothing. N may be Eigen::Dynamic.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;   ///< ascending
  Eigen::Matrix<double, N, N> vectors;  ///< a column each, of length 1
  bool converged = false;
};

/// As symmetric_eigen, of `n` x `n` numbers by column. Only plain numbers pass from a module to
/// this library: one that is compiled without AVX has another allocator for Eigen's matrices.
bool symmetric_eigen(int n, const double* m, double* values, double* vectors);

/// Of a symmetric matrix, of which the lower triangle is read.
template <int N>
SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& m) {
  SymmetricEigen<N> eigen;
  eigen.values.resize(m.rows());
  eigen.vectors.resize(m.rows(), m.rows());
  eigen.converged = symmetric_eigen(static_cast<int>(m.rows()), m.data(), eigen.values.data(),
                                    eigen.vectors.data());
  return eigen;
}

/// x of M x = b, for a symmetric M (LDL', robust Cholesky), of which the lower triangle is read.
Vector6d solve_symmetric(const Matrix6d& m, const Vector6d& b);

/// The inverse of a symmetric M in the same way.
Matrix6d inverse_of_symmetric(const Matrix6d& m);

}  // namespace plumb
