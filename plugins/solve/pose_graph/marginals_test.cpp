#include "marginals.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>

#include "graph_testing.hpp"
#include "plumb/data/io/file_testing.hpp"

namespace plumb::solve_pose_graph {
namespace {

using Joints = std::vector<std::pair<int, int>>;

/// A chain of n blocks and `loops` further joints between random ones.
Joints chain_with_loops(int n, int loops, std::mt19937& random) {
  Joints joints;
  for (int k = 0; k + 1 < n; ++k) joints.emplace_back(k, k + 1);
  for (int k = 0; k < loops; ++k) {
    const int a = static_cast<int>(random() % static_cast<unsigned>(n)),
              b = static_cast<int>(random() % static_cast<unsigned>(n));
    if (a != b) joints.emplace_back(a, b);
  }
  return joints;
}

Matrix6d random_block(std::mt19937& random) {
  std::normal_distribution<double> g;
  Matrix6d block;
  for (int k = 0; k < 36; ++k) block(k) = g(random);
  return block;
}

/// J'J of terms A x_i - B x_j with random A and B, one for each joint, and of block 0, which is
/// held.
Eigen::MatrixXd normal_equations(int n, const Joints& joints, std::mt19937& random) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  for (const auto& [i, j] : joints) {
    const Matrix6d a = random_block(random), b = random_block(random);
    H.block<6, 6>(6 * i, 6 * i) += a.transpose() * a;
    H.block<6, 6>(6 * j, 6 * j) += b.transpose() * b;
    H.block<6, 6>(6 * i, 6 * j) -= a.transpose() * b;
    H.block<6, 6>(6 * j, 6 * i) -= b.transpose() * a;
  }
  H.topLeftCorner<6, 6>() += Matrix6d::Identity();
  return H;
}

Eigen::SparseMatrix<double> lower_of(const Eigen::MatrixXd& H) {
  return Eigen::MatrixXd(H.triangularView<Eigen::Lower>()).sparseView(0, 0);
}

TEST(DiagonalBlocksOfInverse, AreThoseOfTheDenseInverse) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 random(seed);
    const int n = 20 + static_cast<int>(4 * seed);
    Eigen::MatrixXd H = normal_equations(n, chain_with_loops(n, n / 4, random), random);
    H.diagonal().array() += 0.1;  // keeps the dense inverse good to 1e-12
    const Eigen::MatrixXd inverse = H.llt().solve(Eigen::MatrixXd::Identity(6 * n, 6 * n));
    const auto blocks = diagonal_blocks_of_inverse(lower_of(H));
    ASSERT_EQ(blocks.size(), static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) {
      const Matrix6d judge = inverse.block<6, 6>(6 * k, 6 * k);
      EXPECT_LT((blocks[static_cast<std::size_t>(k)] - judge).norm(), 1e-9 * judge.norm())
          << "block " << k << " of " << n;
    }
  }
}

TEST(DiagonalBlocksOfInverse, AreSymmetric) {
  std::mt19937 random(3);
  const auto blocks = diagonal_blocks_of_inverse(
      lower_of(normal_equations(30, chain_with_loops(30, 10, random), random)));
  for (const auto& block : blocks) EXPECT_EQ(block, block.transpose());
}

TEST(DiagonalBlocksOfInverse, OfUnconnectedBlocksAreTheirInverses) {
  std::mt19937 random(4);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(18, 18);
  for (int k = 0; k < 3; ++k) {
    const Matrix6d a = random_block(random);
    H.block<6, 6>(6 * k, 6 * k) = a.transpose() * a + Matrix6d::Identity();
  }
  const auto blocks = diagonal_blocks_of_inverse(lower_of(H));
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(
        (blocks[static_cast<std::size_t>(k)] * H.block<6, 6>(6 * k, 6 * k) - Matrix6d::Identity())
            .norm(),
        1e-12);
}

TEST(DiagonalBlocksOfInverse, AreRefusedWhereADirectionIsFree) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(12, 12);
  H(9, 9) = 0;
  EXPECT_THROW(diagonal_blocks_of_inverse(lower_of(H)), Error);
  H(9, 9) = -1;
  EXPECT_THROW(diagonal_blocks_of_inverse(lower_of(H)), Error);
}

TEST(DiagonalBlocksOfInverse, AreRefusedWhereNothingHoldsTheGraph) {
  // The sum of |x_k - x_k+1|^2: all of them may move together. Small whole numbers, so that the
  // last pivot is 0 without rounding.
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(120, 120);
  for (int k = 0; k + 6 < 120; ++k) {
    H(k, k) += 1, H(k + 6, k + 6) += 1;
    H(k, k + 6) -= 1, H(k + 6, k) -= 1;
  }
  EXPECT_THAT(io::refusal([&] { diagonal_blocks_of_inverse(lower_of(H)); }),
              testing::HasSubstr("leaves a direction free"));
  H.topLeftCorner<6, 6>() += Matrix6d::Identity();
  EXPECT_NO_THROW(diagonal_blocks_of_inverse(lower_of(H)));
}

}  // namespace
}  // namespace plumb::solve_pose_graph
