#include "costs.hpp"

#include <gtest/gtest.h>

#include <random>

#include "graph_testing.hpp"
#include "plumb/data/error.hpp"
#include "pose_manifold.hpp"

namespace plumb::solve_pose_graph {
namespace {

Pose random_pose(std::mt19937& random) {
  return {exp_rotation(gauss3(random, 0.7)), gauss3(random, 10)};
}

Matrix6d random_information(std::mt19937& random) {
  std::normal_distribution<double> g;
  const Matrix6d a = Matrix6d::NullaryExpr([&] { return g(random); });
  return a * a.transpose() + Matrix6d::Identity();
}

/// Compares a cost's derivatives with central differences along the manifold.
void expect_right_derivatives(const ceres::CostFunction& cost, const std::vector<Pose>& poses) {
  std::vector<PoseBlock> blocks;
  for (const auto& pose : poses) blocks.push_back(block_of(pose));
  const int rows = cost.num_residuals();
  for (std::size_t end = 0; end < blocks.size(); ++end) {
    std::vector<const double*> at;
    for (const auto& b : blocks) at.push_back(b.data());
    Eigen::VectorXd residual(rows);
    Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor> jacobian(rows, 7);
    std::vector<double*> jacobians(blocks.size(), nullptr);
    jacobians[end] = jacobian.data();
    ASSERT_TRUE(cost.Evaluate(at.data(), residual.data(), jacobians.data()));
    const PoseManifold manifold(false);
    const double h = 1e-5;
    for (int k = 0; k < 6; ++k) {
      Eigen::VectorXd side[2] = {Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
      for (int s = 0; s < 2; ++s) {
        Vector6d move = Vector6d::Zero();
        move[k] = s ? h : -h;
        PoseBlock moved;
        manifold.Plus(blocks[end].data(), move.data(), moved.data());
        auto there = at;
        there[end] = moved.data();
        cost.Evaluate(there.data(), side[s].data(), nullptr);
      }
      const Eigen::VectorXd slope = (side[1] - side[0]) / (2 * h);
      EXPECT_LT((slope - jacobian.col(k)).norm(), 1e-6 * (1 + slope.norm() + residual.norm()))
          << "pose " << end << " direction " << k;
    }
  }
}

TEST(Costs, HaveTheDerivativesThatFiniteDifferencesFind) {
  std::mt19937 random(5);
  const double weight = 0.7;
  for (int trial = 0; trial < 20; ++trial) {
    const Pose a = random_pose(random), b = random_pose(random);
    const RelativePose constraint{0, 1, random_pose(random), random_information(random)};
    expect_right_derivatives(G2oCost(constraint, &weight), {a, b});
    expect_right_derivatives(ChordalCost(constraint, false, &weight), {a, b});
    expect_right_derivatives(AbsolutePoseCost({0, random_pose(random), constraint.information}),
                             {a});
    expect_right_derivatives(AbsolutePointCost({0, gauss3(random, 5), gauss3(random, 5),
                                                Eigen::Matrix3d::Identity() * 4}),
                             {a});

    PairForm form;
    form.about = {random_pose(random), gauss3(random, 5)};
    PointPairSums sums;
    for (int k = 0; k < 20; ++k) sums.add(gauss3(random, 8), gauss3(random, 1), 1);
    form.factor = factor_of(sums.moments());
    expect_right_derivatives(PairCost(&form, &weight), {a, b});
  }
}

TEST(Costs, OfAnEdgeIsTheSumOverItsPairs) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose T_i = random_pose(random), T_j = random_pose(random), near = T_j.inverse() * T_i;
    PairForm form;
    form.about = {near * Pose(exp_rotation(gauss3(random, 0.02)), gauss3(random, 0.3)),
                  gauss3(random, 9)};
    PointPairSums sums;
    double expected = 0;
    for (int k = 0; k < 1000; ++k) {
      const Eigen::Vector3d p = gauss3(random, 30), q = near * p + gauss3(random, 0.1);
      sums.add(p - form.about.centre, form.about.T_j_i * p - q, 0.5);
      expected += 0.5 * (T_i * p - T_j * q).squaredNorm();
    }
    form.factor = factor_of(sums.moments());
    const double one = 1;
    const PoseBlock a = block_of(T_i), b = block_of(T_j);
    const double* poses[] = {a.data(), b.data()};
    Vector13d residual;
    PairCost(&form, &one).Evaluate(poses, residual.data(), nullptr);
    EXPECT_NEAR(residual.squaredNorm() / expected, 1, 1e-9);
  }
}

TEST(PoseManifold, UndoesPlusByMinus) {
  std::mt19937 random(2);
  for (const bool planar : {false, true}) {
    const PoseManifold manifold(planar);
    const auto x = block_of(random_pose(random));
    Eigen::VectorXd move = 0.3 * Eigen::VectorXd::Ones(manifold.TangentSize()),
                    back(manifold.TangentSize());
    PoseBlock y;
    manifold.Plus(x.data(), move.data(), y.data());
    manifold.Minus(y.data(), x.data(), back.data());
    EXPECT_LT((move - back).norm(), 1e-12);
  }
}

TEST(InformationRoot, TakesMatricesWithoutFullRankAndRefusesNegativeOnes) {
  Matrix6d flat = Matrix6d::Zero();
  flat(0, 0) = 4;
  flat(5, 5) = 9;
  const Eigen::MatrixXd root = information_root(flat);
  EXPECT_LT((root.transpose() * root - flat).norm(), 1e-12);
  flat(1, 1) = -1;
  EXPECT_THROW(information_root(flat), Error);
}

}  // namespace
}  // namespace plumb::solve_pose_graph
