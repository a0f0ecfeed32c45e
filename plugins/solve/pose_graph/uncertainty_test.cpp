/// The uncertainty of poses: what the marginals of a whole graph say, and whether they foretell
/// errors.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>

#include "graph_testing.hpp"
#include "plumb/data/error.hpp"
#include "plumb/slam/geometry/pair_moments.hpp"

namespace plumb::solve_pose_graph {
namespace {

constexpr double sigma_t = 0.1, sigma_r = 0.002;  // of each constraint: [m], [rad]

RelativePose constraint(std::uint32_t i, std::uint32_t j, const Pose& T_i_j) {
  RelativePose r{i, j, T_i_j, Matrix6d::Zero()};
  r.information.diagonal().head<3>().setConstant(1 / (sigma_t * sigma_t));
  r.information.diagonal().tail<3>().setConstant(4 /
                                                 (sigma_r * sigma_r));  // of q.vec, half the angle
  return r;
}

struct Chain {
  Poses poses;
  Constraints constraints;
};

/// n poses, each `motion` after the one before, and the constraints that say so.
Chain chain_of(int n, const Pose& motion) {
  Chain chain;
  chain.poses.T_world_segment.resize(1);
  for (std::uint32_t k = 1; k < static_cast<std::uint32_t>(n); ++k) {
    chain.poses.T_world_segment.push_back(chain.poses.T_world_segment.back() * motion);
    chain.constraints.relative.push_back(constraint(k - 1, k, motion));
  }
  return chain;
}

/// Least squares with the uncertainty that H alone gives: nothing is added to it for each metre,
/// and only the variance factor multiplies it.
GraphOptions uncertain() {
  GraphOptions options;
  options.loss = Loss::none;
  options.uncertainty = true;
  options.uncertainty_factor = 1;
  options.uncertainty_per_metre = 0;
  return options;
}

GraphResult solved(const Chain& chain, const GraphOptions& options) {
  return solve_pose_graph(chain.poses, {}, &chain.constraints, options, in_order);
}

double variance_factor(const GraphResult& result) {
  const auto found = std::ranges::find(result.metrics.numbers, "variance_factor", &Number::name);
  EXPECT_NE(found, result.metrics.numbers.end());
  return found == result.metrics.numbers.end() ? 0 : found->value;
}

/// Each pose's covariance of (t [m], angle [rad]) in its own axes, the first pose's being zero,
/// without the factors that multiply all of them.
std::vector<Matrix6d> covariances(const Chain& chain, const GraphOptions& options = uncertain()) {
  const auto result = solved(chain, options);
  EXPECT_EQ(result.uncertainty.absolute.size(), chain.poses.size() - 1);
  const double factor = variance_factor(result) * std::pow(options.uncertainty_factor, 2);
  const Vector6d from_q = (Vector6d() << 1, 1, 1, 2, 2, 2).finished();
  std::vector<Matrix6d> all(chain.poses.size(), Matrix6d::Zero());
  for (const auto& a : result.uncertainty.absolute)
    all[a.i] = from_q.asDiagonal() * a.information.inverse() * from_q.asDiagonal() / factor;
  return all;
}

/// What an error (t, angle) in the axes of b becomes in the axes of a, rigidly joined to it.
Matrix6d carried(const Pose& T_a_b) {
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = m.bottomRightCorner<3, 3>() = T_a_b.matrix();
  m.topRightCorner<3, 3>() = cross_matrix(T_a_b.translation) * T_a_b.matrix();
  return m;
}

TEST(Uncertainty, OfAStraightChainGrowsAsTheSumOfItsConstraints) {
  const auto all = covariances(chain_of(30, Pose(Eigen::Quaterniond::Identity(), {10, 0, 0})));
  for (int k = 1; k < 30; ++k) {
    const Matrix6d& c = all[static_cast<std::size_t>(k)];
    EXPECT_NEAR(c(0, 0), k * sigma_t * sigma_t, 1e-7 * k * sigma_t * sigma_t)
        << "along, pose " << k;
    for (int axis = 3; axis < 6; ++axis)
      EXPECT_NEAR(c(axis, axis), k * sigma_r * sigma_r, 1e-7 * k * sigma_r * sigma_r);
    double across = 0;  // a constraint's angle swings all that follows it
    for (int from = 1; from <= k; ++from)
      across += sigma_t * sigma_t + std::pow(sigma_r * 10 * (k - from), 2);
    EXPECT_NEAR(c(1, 1), across, 1e-7 * across) << "across, pose " << k;
    EXPECT_NEAR(c(2, 2), across, 1e-7 * across) << "up, pose " << k;
  }
}

TEST(Uncertainty, OfABentChainIsWhatEachConstraintsErrorBecomesAtItsEnd) {
  const Chain chain = chain_of(25, Pose(exp_rotation({0.02, -0.05, 0.2}), {6, 1, -0.5}));
  const auto all = covariances(chain);
  const Matrix6d one = (Vector6d() << Eigen::Vector3d::Constant(sigma_t * sigma_t),
                        Eigen::Vector3d::Constant(sigma_r * sigma_r))
                           .finished()
                           .asDiagonal();
  for (std::size_t k = 1; k < 25; ++k) {
    Matrix6d sum = Matrix6d::Zero();
    for (std::size_t from = 1; from <= k; ++from) {
      const Matrix6d carry = carried(chain.poses.relative(k, from));
      sum += carry * one * carry.transpose();
    }
    EXPECT_LT((all[k] - sum).norm(), 1e-7 * sum.norm()) << "pose " << k;
  }
}

/// Variances in a loop add as resistors do: two ways to a pose are parallel.
TEST(Uncertainty, IsTighterWithALoop) {
  constexpr std::uint32_t n = 21;
  Chain chain = chain_of(n, Pose(Eigen::Quaterniond::Identity(), {10, 0, 0}));
  const auto open = covariances(chain);
  // It says 0.3 m more than the chain, or nothing would tell of errors.
  chain.constraints.relative.push_back(
      constraint(0, n - 1, Pose(Eigen::Quaterniond::Identity(), {10.0 * (n - 1) + 0.3, 0, 0})));
  const auto closed = covariances(chain);
  for (std::uint32_t k = 1; k < n; ++k) {
    const double chain_way = k, loop_way = n - k,
                 parallel = chain_way * loop_way / (chain_way + loop_way) * sigma_t * sigma_t;
    EXPECT_NEAR(closed[k](0, 0), parallel, 1e-6 * parallel) << "pose " << k;
    for (int axis = 0; axis < 6; ++axis)
      EXPECT_LT(closed[k](axis, axis), open[k](axis, axis)) << "pose " << k;
  }
}

TEST(Uncertainty, IsMultipliedByItsFactor) {
  const Chain chain = chain_of(5, Pose(Eigen::Quaterniond::Identity(), {10, 0, 0}));
  auto options = uncertain();
  const auto once = solved(chain, options);
  options.uncertainty_factor = 3;
  const auto thrice = solved(chain, options);
  // Nothing contradicts a chain, so its constraints are believed: the variance factor is 1.
  EXPECT_EQ(variance_factor(once), 1);
  EXPECT_NEAR(once.uncertainty.absolute[3].information(0, 0), 1 / (4 * sigma_t * sigma_t), 1e-6);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT(
        (9 * thrice.uncertainty.absolute[k].information - once.uncertainty.absolute[k].information)
            .norm(),
        1e-9 * once.uncertainty.absolute[k].information.norm());
}

TEST(Uncertainty, GrowsByItsShareOfTheDistanceFromTheFirstPose) {
  const Chain chain = chain_of(5, Pose(exp_rotation({0, 0, 0.3}), {10, 0, 0}));
  auto options = uncertain();
  const auto without = covariances(chain, options);
  options.uncertainty_per_metre = 0.01;
  const auto with = covariances(chain, options);
  for (std::size_t k = 1; k < 5; ++k) {
    const double more = std::pow(0.01 * chain.poses.T_world_segment[k].translation.norm(), 2);
    for (int axis = 0; axis < 6; ++axis)
      EXPECT_NEAR(with[k](axis, axis), without[k](axis, axis) + (axis < 3 ? more : 0),
                  1e-7 * with[k](axis, axis))
          << k << ", " << axis;
  }
}

/// Constraints of the circle with errors `times` as large as they say.
Chain noisy_circle(double times, std::uint32_t seed) {
  const auto g = circle(40, 2, seed);
  std::mt19937 random(seed);
  Chain chain{g.truth, {}};
  for (const auto& e : g.edges)
    chain.constraints.relative.push_back(constraint(
        e.i, e.j,
        g.truth.relative(e.i, e.j) *
            Pose(exp_rotation(gauss3(random, times * sigma_r)), gauss3(random, times * sigma_t))));
  return chain;
}

TEST(Uncertainty, LearnsFromTheirDisagreementHowLargeTheErrorsAre) {
  for (const double times : {0.3, 1.0, 2.0}) {
    double mean = 0;
    for (std::uint32_t seed = 1; seed <= 5; ++seed)
      mean += variance_factor(solved(noisy_circle(times, seed), uncertain())) / 5;
    EXPECT_NEAR(mean / (times * times), 1, 0.15) << times;
  }
}

/// e'Omega e of the errors e of poses, whose mean is 6 where Omega is right.
double mean_squared_error(const GraphResult& result, const Poses& truth) {
  double sum = 0;
  for (const auto& a : result.uncertainty.absolute) {
    const Pose error = a.T_world_i.inverse() * truth.T_world_segment[a.i];
    Vector6d e;
    e << error.translation, 0.5 * log_rotation(error.rotation);
    sum += e.dot(a.information * e);
  }
  return sum / static_cast<double>(result.uncertainty.absolute.size());
}

TEST(Uncertainty, ForetellsHowFarPosesAreFromTheTruth) {
  double mean = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const Chain chain = noisy_circle(1, seed);
    mean += mean_squared_error(solved(chain, uncertain()), chain.poses) / 10;
  }
  EXPECT_NEAR(mean, 6, 1.5);
}

/// The same of pairs, 40 an edge with 0.05 m of noise, whatever deviation 'scale' says that they
/// have.
TEST(Uncertainty, OfPairsForetellsHowFarPosesAreFromTheTruth) {
  for (const double scale : {0.05, 0.5}) {
    double mean = 0;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const auto g = circle(20, 2, seed);
      auto options = uncertain();
      options.scale = scale;
      mean += mean_squared_error(
                  solve_pose_graph(g.drifted, g.matched(), nullptr, options, in_order), g.truth) /
              5;
    }
    EXPECT_NEAR(mean, 6, 2) << scale;
  }
}

/// Beside constraints that err ten times as much as the pairs, poses come out as near to the truth
/// whatever 'scale' says of the pairs.
TEST(EstimateVariance, FindsWhatEdgesAreWorthBesideConstraints) {
  double right = 0, wrong = 0, estimated = 0, without_loss = 0;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const auto g = circle(20, 2, seed);
    std::mt19937 random(seed);
    Constraints odometry;
    for (std::uint32_t k = 0; k + 1 < g.truth.size(); ++k)
      odometry.relative.push_back(constraint(
          k, k + 1,
          g.truth.relative(k, k + 1) *
              Pose(exp_rotation(gauss3(random, 10 * sigma_r)), gauss3(random, 3 * sigma_t))));
    for (auto& r : odometry.relative)
      r.information.topLeftCorner<3, 3>() /= 9, r.information.bottomRightCorner<3, 3>() /= 100;
    const auto error = [&](double scale, bool estimate, Loss loss = Loss::huber) {
      auto options = uncertain();
      options.scale = scale;
      options.estimate_variance = estimate;
      options.loss = loss;
      return ate(solve_pose_graph(g.drifted, g.matched(), &odometry, options, in_order).poses,
                 g.truth);
    };
    right += error(0.05, false);
    wrong += error(5, false);
    estimated += error(5, true);
    without_loss += error(5, true, Loss::none);
  }
  EXPECT_GT(wrong, 3 * right) << "or nothing is shown";
  EXPECT_LT(estimated, 1.3 * right);
  EXPECT_LT(without_loss, 1.3 * right);
}

TEST(Uncertainty, DoesNotCountAConstraintThatTheLossLetGo) {
  Chain chain = noisy_circle(1, 3);
  auto options = uncertain();
  options.loss = Loss::geman_mcclure;
  const auto without = solved(chain, options);
  auto wrong = constraint(
      3, 40, chain.poses.relative(3, 40) * Pose(Eigen::Quaterniond::Identity(), {30, 0, 0}));
  wrong.information *= 100;
  chain.constraints.relative.push_back(wrong);
  const auto with = solved(chain, options);
  ASSERT_EQ(with.uncertainty.absolute.size(), without.uncertainty.absolute.size());
  for (std::size_t k = 0; k < with.uncertainty.absolute.size(); ++k)
    EXPECT_NEAR(with.uncertainty.absolute[k].information(0, 0) /
                    without.uncertainty.absolute[k].information(0, 0),
                1, 0.05)
        << k;
}

TEST(Uncertainty, IsGivenForEachPoseButTheFixedOnesAndOnlyIfAskedFor) {
  Chain chain = chain_of(6, Pose(Eigen::Quaterniond::Identity(), {10, 0, 0}));
  EXPECT_TRUE(solved(chain, GraphOptions()).uncertainty.absolute.empty());
  chain.constraints.relative.erase(chain.constraints.relative.begin() + 2);  // 0 1 2 | 3 4 5
  std::vector<std::uint32_t> named;
  for (const auto& a : solved(chain, uncertain()).uncertainty.absolute) named.push_back(a.i);
  EXPECT_THAT(named, testing::ElementsAre(1, 2, 4, 5));
}

TEST(Uncertainty, IsNotGivenInThePlane) {
  Chain chain = chain_of(6, Pose(Eigen::Quaterniond::Identity(), {10, 0, 0}));
  chain.constraints.planar = true;
  EXPECT_TRUE(solved(chain, uncertain()).uncertainty.absolute.empty());
}

TEST(Uncertainty, IsLeftOutWithAWarningWhereAConstraintLeavesAPoseFree) {
  Chain chain = chain_of(4, Pose(Eigen::Quaterniond::Identity(), {10, 0, 0}));
  chain.constraints.relative.back().information(5, 5) = 0;
  const auto result = solved(chain, uncertain());
  EXPECT_TRUE(result.uncertainty.absolute.empty());
  EXPECT_THAT(
      result.warnings,
      testing::ElementsAre(testing::HasSubstr("no uncertainty: give odometry or more edges")));
  EXPECT_EQ(result.poses.size(), 4u);
}

}  // namespace
}  // namespace plumb::solve_pose_graph
