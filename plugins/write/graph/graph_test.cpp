#include <gmock/gmock.h>

#include <random>
#include <sstream>

#include "graph_text.hpp"

namespace plumb::write_graph {
namespace {

Eigen::Vector3d gauss3(std::mt19937& random, double sigma) {
  std::normal_distribution<double> g(0, sigma);
  const double x = g(random), y = g(random), z = g(random);
  return {x, y, z};
}

Matches pairs(const Pose& T_i_j, int count, double noise, std::mt19937& random) {
  Matches m;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d p = gauss3(random, 10);
    m.p.push_back(p.cast<float>());
    m.q.push_back((T_i_j.inverse() * p + gauss3(random, noise)).cast<float>());
  }
  return m;
}

Vector6d g2o_error(const Pose& Z, const Pose& T_i_j) {
  const Pose e = Z.inverse() * T_i_j;
  Vector6d v;
  v << e.translation, (e.rotation.w() < 0 ? -1 : 1) * e.rotation.vec();
  return v;
}

TEST(ConstraintOf, IsTheTruePoseForExactPairs) {
  std::mt19937 random(1);
  const Pose truth(exp_rotation({0.1, 0.2, 0.5}), {5, 3, 1});
  const auto constraint = constraint_of({2, 4}, pairs(truth, 50, 0, random),
                                        truth * Pose(exp_rotation({0, 0, 0.1}), {1, 0, 0}), 0.1);
  ASSERT_TRUE(constraint);
  EXPECT_EQ(constraint->j, 4u);
  EXPECT_LT(g2o_error(constraint->T_i_j, truth).norm(), 1e-5);
}

TEST(ConstraintOf, HasTheInformationWithWhichTheCostOfThePairsRises) {
  std::mt19937 random(2);
  const Pose truth(exp_rotation({0.1, 0.2, 0.5}), {5, 3, 1});
  const double noise = 0.05;
  const auto m = pairs(truth, 500, noise, random);
  const auto constraint = *constraint_of({0, 1}, m, truth, noise);
  const auto cost = [&](const Pose& T_i_j) {
    double sum = 0;
    for (std::size_t k = 0; k < m.size(); ++k)
      sum += (m.p[k].cast<double>() - T_i_j * m.q[k].cast<double>().eval()).squaredNorm();
    return sum / (noise * noise);
  };
  const double least = cost(constraint.T_i_j);
  for (int trial = 0; trial < 10; ++trial) {
    const Pose moved =
        constraint.T_i_j * Pose(exp_rotation(gauss3(random, 1e-4)), gauss3(random, 1e-3));
    const Vector6d e = g2o_error(constraint.T_i_j, moved);
    EXPECT_NEAR(e.dot(constraint.information * e) / (cost(moved) - least), 1, 0.01);
  }
}

TEST(ConstraintOf, SpreadsAsItsInformationSays) {
  std::mt19937 random(3);
  const Pose truth(exp_rotation({0, 0, 1}), {5, 3, 1});
  double chi2 = 0;
  const int trials = 200;
  for (int k = 0; k < trials; ++k) {
    const auto constraint =
        *constraint_of({0, 1}, pairs(truth, 60, 0.1, random), truth, std::nullopt);
    const Vector6d e = g2o_error(constraint.T_i_j, truth);
    chi2 += e.dot(constraint.information * e);
  }
  EXPECT_NEAR(chi2 / trials, 6, 1);
}

TEST(ConstraintOf, NeedsThreePairs) {
  std::mt19937 random(4);
  EXPECT_FALSE(constraint_of({0, 1}, pairs(Pose(), 2, 0, random), Pose(), std::nullopt));
}

TEST(G2oText, HasVerticesTheFixedOneAndEdgesInUpperTriangles) {
  Poses poses;
  poses.T_world_segment = {Pose(),
                           Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(1.5, 0, -2))};
  Constraints constraints;
  constraints.relative = {{0, 1, poses.relative(0, 1), Matrix6d::Identity() * 4}};
  EXPECT_EQ(g2o_text(poses, constraints),
            "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
            "VERTEX_SE3:QUAT 1 1.5 0 -2 0 0 0 1\n"
            "FIX 0\n"
            "EDGE_SE3:QUAT 0 1 1.5 0 -2 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 4 0 0 4 0 4\n");
}

TEST(G2oText, IsPlanarAndKeepsTheFilesNumbersWhereTheConstraintsAreAndDo) {
  Poses poses;
  poses.T_world_segment = {Pose(), Pose(exp_rotation({0, 0, 0.5}), {1, 2, 0})};
  Constraints constraints;
  constraints.planar = true;
  constraints.ids = {7, 9};
  Matrix6d information = Matrix6d::Identity();
  information(5, 5) = 40;  // of q.z, so 10 of the angle
  constraints.relative = {{0, 1, poses.relative(0, 1), information}};
  const auto text = g2o_text(poses, constraints);
  EXPECT_THAT(
      text,
      testing::StartsWith(
          "VERTEX_SE2 7 0 0 0\nVERTEX_SE2 9 1 2 0.5\nFIX 7\nEDGE_SE2 7 9 1 2 0.5 1 0 0 1 0 10\n"));
}

}  // namespace
}  // namespace plumb::write_graph
