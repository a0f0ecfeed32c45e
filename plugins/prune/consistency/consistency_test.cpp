#include "consistency.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::prune_consistency {
namespace {

Eigen::Vector3f in_cube(Random& random, float half) {
  Eigen::Vector3f v;
  for (int c = 0; c < 3; ++c) v[c] = half * static_cast<float>(2 * random.uniform() - 1);
  return v;
}

const Pose motion(exp_rotation({0.1, -0.2, 0.9}), {5, -3, 1});

/// `right` pairs that follow `motion` to within `noise` [m] on each axis, then `wrong` ones of
/// unrelated points.
Matches planted(int right, int wrong, std::uint64_t seed, float noise = 0.05f) {
  Random random(seed);
  Matches m;
  for (int k = 0; k < right + wrong; ++k) {
    m.q.push_back(in_cube(random, 30));
    m.p.push_back(k < right ? Eigen::Vector3f(Motion(motion) * m.q.back() + in_cube(random, noise))
                            : in_cube(random, 30));
    m.index_p.push_back(static_cast<std::uint32_t>(k));
  }
  return m;
}
ConsistencyOptions within(double distance, Select select = Select::clique) {
  ConsistencyOptions options;
  options.max_correspondence_distance = distance;
  options.select = select;
  return options;
}
Matches run(const Matches& matches, TestContext& context, const std::string& select = "clique") {
  return StepUnderTest(*plumb_module())
      .with("matches", matches)
      .set("max_correspondence_distance", 0.2)
      .set("select", select)
      .run<Matches>("matches", context);
}

TEST(ConsistentPairs, AreThoseOfTheMotionAmong95PercentWrongOnes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto found = consistent_pairs(planted(30, 570, seed), within(0.2));
    const Pose error = motion.inverse() * found.T_i_j;
    EXPECT_LT(error.translation.norm(), 0.06) << seed;
    EXPECT_LT(angle(error), 0.003) << seed;
    EXPECT_TRUE(found.largest) << seed;
    EXPECT_GE(found.selected, 30u) << "the right ones are a clique";
    ASSERT_GE(found.inliers.size(), 30u) << seed;
    EXPECT_LE(found.inliers.size(), 32u) << seed;
    EXPECT_EQ(found.inliers[29], 29u) << seed;
  }
}

TEST(ConsistentPairs, OfTheCoreAreTheSameWhereEnoughAreRight) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Matches matches = planted(80, 320, seed);
    EXPECT_EQ(consistent_pairs(matches, within(0.2, Select::core)).inliers,
              consistent_pairs(matches, within(0.2)).inliers)
        << seed;
  }
}

TEST(ConsistentPairs, AreAllThatFitAndNoneThatDoesNot) {
  const Matches matches = planted(60, 140, 5, 0.2f);
  const auto found = consistent_pairs(matches, within(0.3));
  std::vector<std::uint32_t> fitting;
  for (std::uint32_t k = 0; k < matches.size(); ++k)
    if ((matches.p[k].cast<double>() - found.T_i_j * matches.q[k].cast<double>().eval()).norm() <=
        0.3)
      fitting.push_back(k);
  EXPECT_EQ(found.inliers, fitting);
  EXPECT_GT(fitting.size(), 50u);
}

TEST(ConsistentPairs, AreFoundInSomeOfThePairsAndCountedInAll) {
  Matches all = planted(600, 1400, 6), mixed;
  for (std::size_t k = 0; k < all.size(); ++k) {  // 701 and 2000 have no divisor in common
    const std::size_t from = k * 701 % all.size();
    mixed.p.push_back(all.p[from]);
    mixed.q.push_back(all.q[from]);
  }
  ConsistencyOptions options = within(0.2);
  options.max_pairs = 200;
  const auto found = consistent_pairs(mixed, options);
  EXPECT_LE(found.selected, 200u);
  EXPECT_GE(found.inliers.size(), 600u);
  EXPECT_LT((motion.inverse() * found.T_i_j).translation.norm(), 0.05);
}

TEST(ConsistentPairs, AreNotFoundWherePairsFitNoMotion) {
  Matches stretched = planted(40, 0, 1);
  for (auto& p : stretched.p) p *= 3;
  EXPECT_LT(consistent_pairs(stretched, within(0.1)).inliers.size(), 6u);
  EXPECT_LT(consistent_pairs(planted(0, 300, 2), within(0.1)).inliers.size(), 12u);
}

/// What graduated_fit minimises, at a motion.
double truncated_cost(const Matches& m, const Pose& T_i_j, double limit) {
  double sum = 0;
  for (std::size_t k = 0; k < m.size(); ++k)
    sum += std::min(limit * limit,
                    (m.p[k].cast<double>() - T_i_j * m.q[k].cast<double>().eval()).squaredNorm());
  return sum;
}

TEST(GraduatedFit, FindsTheMotionAmongHalfWrongPairsAndNoBetterOneIsNear) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Matches matches = planted(40, 40, seed);
    std::vector<std::uint32_t> all(matches.size());
    std::iota(all.begin(), all.end(), 0);
    Pose fitted;
    const auto weights = graduated_fit(matches, all, 0.2, fitted);
    for (std::size_t k = 0; k < 40; ++k) EXPECT_EQ(weights[k], 1) << seed;
    EXPECT_LE(std::accumulate(weights.begin(), weights.end(), 0.0), 41) << seed;
    const double cost = truncated_cost(matches, fitted, 0.2);
    Random random(seed);
    for (int n = 0; n < 50; ++n) {
      const Pose aside(exp_rotation(1e-3 * in_cube(random, 1).cast<double>()),
                       0.02 * in_cube(random, 1).cast<double>());
      EXPECT_GE(truncated_cost(matches, fitted * aside, 0.2), cost - 1e-9) << seed;
    }
  }
}

TEST(GraduatedFit, OfPairsThatAllFitIsThePlainFit) {
  const Matches matches = planted(20, 0, 3);
  std::vector<std::uint32_t> all(20);
  std::iota(all.begin(), all.end(), 0);
  Pose fitted;
  EXPECT_EQ(graduated_fit(matches, all, 0.5, fitted), std::vector<double>(20, 1));
  EXPECT_LT((motion.inverse() * fitted).translation.norm(), 0.1);
}

TEST(PruneConsistency, KeepsTheInliersAndCountsTheRest) {
  for (const std::string select : {"clique", "core"}) {
    TestContext a(1), b(2);
    const Matches matches = planted(60, 140, 7);
    const Matches kept = run(matches, a, select);
    EXPECT_GE(kept.size(), 60u) << select;
    EXPECT_LE(kept.size(), 63u) << select;
    EXPECT_EQ(a.counts["pairs dropped"], 200 - kept.size()) << select;
    EXPECT_EQ(run(matches, b, select).index_p, kept.index_p) << "no seed matters";
  }
}

TEST(PruneConsistency, SaysWhereItFoundNoMotion) {
  TestContext context;
  Matches apart = planted(0, 8, 1);  // lengths that no other pair has
  for (std::size_t k = 0; k < apart.size(); ++k) apart.p[k] *= static_cast<float>(1 << (2 * k));
  EXPECT_EQ(run(apart, context).size(), 0u);
  EXPECT_EQ(context.counts["edges without any motion"], 1u);
  EXPECT_EQ(context.counts["pairs dropped"], 8u);
}

TEST(PruneConsistency, KeepsFivePairsAsTheyAreAndSaysSo) {
  TestContext context;
  EXPECT_EQ(run(planted(1, 4, 1), context).size(), 5u);
  EXPECT_EQ(context.counts["edges with too few pairs to compare, kept whole"], 1u);
  EXPECT_EQ(run(Matches(), context).size(), 0u);
}

TEST(PruneConsistency, MultipliesItsLengthsByTheScale) {
  Matches small = planted(30, 70, 8);
  for (auto* points : {&small.p, &small.q})
    for (auto& point : *points) point *= 0.1f;
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("matches", small).set("max_correspondence_distance", 0.2);
  step.with("scale", Metrics().add("scale", 0.1, ""));
  const Matches kept = step.run<Matches>("matches", context);
  EXPECT_GE(kept.size(), 30u);
  EXPECT_LE(kept.size(), 32u);
}

}  // namespace
}  // namespace plumb::prune_consistency
