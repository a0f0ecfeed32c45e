#include "plumb/slam/geometry/pair_moments.hpp"

#include <gtest/gtest.h>

#include <random>

namespace plumb {
namespace {

struct Pairs {
  std::vector<Eigen::Vector3d> p, q, n;
  std::vector<double> w;
};

Pose random_pose(std::mt19937& random, double shift, double turn) {
  std::normal_distribution<double> g;
  return {exp_rotation(turn * Eigen::Vector3d(g(random), g(random), g(random))),
          shift * Eigen::Vector3d(g(random), g(random), g(random))};
}

Pairs pairs_near(std::mt19937& random, const Pose& T_j_i, const Eigen::Vector3d& place, int count) {
  std::normal_distribution<double> g;
  Pairs pairs;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d p =
        place + Eigen::Vector3d(30 * g(random), 30 * g(random), 3 * g(random));
    pairs.p.push_back(p);
    pairs.q.push_back(T_j_i * p + 0.02 * Eigen::Vector3d(g(random), g(random), g(random)));
    pairs.n.push_back(Eigen::Vector3d(g(random), g(random), g(random)).normalized());
    pairs.w.push_back(std::abs(g(random)));
  }
  return pairs;
}

PairForm form_of(const Pairs& pairs, const Pose& T0, bool to_plane) {
  PairForm form;
  form.about.T_j_i = T0;
  for (const auto& p : pairs.p) form.about.centre += p / static_cast<double>(pairs.p.size());
  PointPairSums points;
  PlanePairSums planes;
  for (std::size_t k = 0; k < pairs.p.size(); ++k) {
    const Eigen::Vector3d d = T0 * pairs.p[k] - pairs.q[k], p = pairs.p[k] - form.about.centre;
    points.add(p, d, pairs.w[k]);
    planes.add(p, pairs.n[k], pairs.n[k].dot(d), pairs.w[k]);
  }
  form.factor = factor_of(to_plane ? planes.moments() : points.moments());
  return form;
}

/// Cost and gradient (v, w of T -> (R exp(w), t + v)) pair by pair.
std::pair<double, Vector6d> pair_by_pair(const Pairs& pairs, const Pose& T, bool to_plane) {
  double cost = 0;
  Vector6d gradient = Vector6d::Zero();
  for (std::size_t k = 0; k < pairs.p.size(); ++k) {
    Eigen::Vector3d d = T * pairs.p[k] - pairs.q[k];
    if (to_plane) d = pairs.n[k] * pairs.n[k].dot(d);
    cost += pairs.w[k] * d.squaredNorm();
    gradient.head<3>() += 2 * pairs.w[k] * d;
    gradient.tail<3>() += 2 * pairs.w[k] * (-T.matrix() * cross_matrix(pairs.p[k])).transpose() * d;
  }
  return {cost, gradient};
}

class MomentForm : public testing::TestWithParam<bool> {};

TEST_P(MomentForm, EqualsThePairByPairCostAndGradientAlsoAtLargeCoordinates) {
  std::mt19937 random(7);
  for (const double place : {0.0, 500.0, 2000.0}) {
    const Pose truth = random_pose(random, place + 1, 0.5);
    const auto pairs = pairs_near(random, truth, Eigen::Vector3d(place, -place, 1), 1000);
    const auto form = form_of(pairs, truth, GetParam());
    for (const double turn : {0.0, 1e-4, 1e-2, 0.3}) {
      const Pose T = truth * Pose(Eigen::Quaterniond::Identity(), form.about.centre) *
                     random_pose(random, 20 * turn, turn) *
                     Pose(Eigen::Quaterniond::Identity(), -form.about.centre);
      const auto [cost, gradient] = pair_by_pair(pairs, T, GetParam());
      const auto residual = form.residual(T.matrix(), T.translation);
      const Vector6d moment_gradient = 2 * form.jacobian(T.matrix()).transpose() * residual;
      EXPECT_NEAR(residual.squaredNorm() / cost, 1, 1e-9) << place << " " << turn;
      EXPECT_LT((moment_gradient - gradient).norm(), 1e-9 * gradient.norm())
          << place << " " << turn;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PointsAndPlanes, MomentForm, testing::Bool());

TEST(FittedPose, IsTheTrueOneForExactPairs) {
  std::mt19937 random(3);
  const Pose truth = random_pose(random, 30, 0.4);
  auto pairs = pairs_near(random, truth, {200, 100, 0}, 50);
  for (std::size_t k = 0; k < pairs.p.size(); ++k) pairs.q[k] = truth * pairs.p[k];
  const Pose start = truth * random_pose(random, 0.5, 0.05);
  for (const bool to_plane : {false, true}) {
    const Pose T = fitted(form_of(pairs, start, to_plane));
    EXPECT_LT((T.translation - truth.translation).norm(), 1e-8);
    EXPECT_LT(angle(T.inverse() * truth), 1e-9);
  }
}

TEST(FittedPose, LeavesWhatNoPairSaysAsItIs) {
  PairForm form;  // no pair at all
  form.about.T_j_i = Pose(exp_rotation({0.1, 0.2, 0.3}), {1, 2, 3});
  EXPECT_EQ(fitted(form).translation, form.about.T_j_i.translation);
}

}  // namespace
}  // namespace plumb
