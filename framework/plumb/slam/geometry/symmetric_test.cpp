#include "plumb/slam/geometry/symmetric.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace plumb {
namespace {

/// Symmetric and positive definite, with the eigenvalues 1 to 6.
Matrix6d known() {
  Matrix6d turn = Matrix6d::Identity();
  for (int k = 0; k < 5; ++k) {
    Matrix6d plane = Matrix6d::Identity();
    const double angle = 0.3 + 0.2 * k;
    plane(k, k) = plane(k + 1, k + 1) = std::cos(angle);
    plane(k, k + 1) = -std::sin(angle);
    plane(k + 1, k) = std::sin(angle);
    turn = turn * plane;
  }
  Vector6d values;
  values << 1, 2, 3, 4, 5, 6;
  return turn * values.asDiagonal() * turn.transpose();
}

TEST(SymmetricEigen, FindsTheEigenvaluesThatAMatrixWasMadeOf) {
  const auto eigen = symmetric_eigen(known());
  ASSERT_TRUE(eigen.converged);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(eigen.values(k), k + 1, 1e-12);
  const Matrix6d back = eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
  EXPECT_LT((back - known()).norm(), 1e-12);
}

TEST(SymmetricEigen, SaysThatAMatrixIsNotFinite) {
  Matrix6d m = known();
  m(3, 2) = m(2, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(symmetric_eigen(m).converged);
}

TEST(SolveSymmetric, GivesBackWhatWasMultiplied) {
  Vector6d x;
  x << 1, -2, 3, -4, 5, -6;
  EXPECT_LT((solve_symmetric(known(), known() * x) - x).norm(), 1e-12);
  EXPECT_LT((inverse_of_symmetric(known()) * known() - Matrix6d::Identity()).norm(), 1e-12);
}

TEST(SolveSymmetric, TakesAnIndefiniteMatrix) {
  Matrix6d m = known();
  m(0, 0) -= 10;
  Vector6d x;
  x << 6, 5, 4, 3, 2, 1;
  EXPECT_LT((solve_symmetric(m, m * x) - x).norm(), 1e-10);
}

}  // namespace
}  // namespace plumb
