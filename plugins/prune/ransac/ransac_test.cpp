#include "ransac.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::prune_ransac {
namespace {

const Pose motion(exp_rotation({0.1, -0.2, 0.9}), {5, -3, 1});

/// `right` pairs that follow `motion` to within 0.05 m on each axis, then `wrong` ones of unrelated
/// points.
Matches planted(int right, int wrong, std::uint64_t seed) {
  Random random(seed);
  Matches m;
  for (int k = 0; k < right + wrong; ++k) {
    m.q.push_back(in_cube(random, 30));
    m.p.push_back(k < right ? Eigen::Vector3f(Motion(motion) * m.q.back() + in_cube(random, 0.05f))
                            : in_cube(random, 30));
    m.index_p.push_back(static_cast<std::uint32_t>(k));
  }
  return m;
}

TEST(Ransac, FindsTheMotionAmong80PercentOutliers) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto consensus = ransac(planted(60, 240, seed), {0.2, 0.999, 100000}, Random(seed));
    const Pose error = motion.inverse() * consensus.T_i_j;
    EXPECT_LT(error.translation.norm(), 0.05);
    EXPECT_LT(angle(error), 0.003);
    EXPECT_GE(consensus.inliers.size(), 60u);
    EXPECT_LE(consensus.inliers.size(), 62u);
    EXPECT_EQ(consensus.inliers[59], 59u);
  }
}

TEST(Ransac, DrawsFewSamplesWhereMostPairsAreRight) {
  EXPECT_LT(ransac(planted(95, 5, 1), {0.2, 0.999, 100000}, Random(1)).samples, 30u);
  EXPECT_GT(ransac(planted(20, 80, 1), {0.2, 0.999, 100000}, Random(1)).samples, 300u);
}

TEST(Ransac, NeverDrawsMoreThanItMay) {
  EXPECT_EQ(ransac(planted(0, 100, 1), {0.001, 0.999, 500}, Random(1)).samples, 500u);
}

TEST(Ransac, FindsNothingWherePairsFitNoMotion) {
  Matches stretched = planted(20, 0, 1);
  for (auto& p : stretched.p) p *= 3;
  EXPECT_TRUE(ransac(stretched, {0.1, 0.999, 2000}, Random(1)).inliers.empty());
}

Matches run(const Matches& matches, TestContext& context) {
  return StepUnderTest(*plumb_module())
      .with("matches", matches)
      .set("max_correspondence_distance", 0.2)
      .run<Matches>("matches", context);
}

TEST(Ransac, GivesTheSameForTheSameSeed) {
  const Matches matches = planted(30, 120, 6);
  TestContext a(7), b(7);
  const auto once = run(matches, a);
  EXPECT_EQ(once.index_p, run(matches, b).index_p);
  EXPECT_GE(once.size(), 30u);
  EXPECT_EQ(a.counts["pairs dropped"], 150 - once.size());
}

TEST(Ransac, KeepsFivePairsAsTheyAreAndSaysSo) {
  TestContext context;
  EXPECT_EQ(run(planted(1, 4, 1), context).size(), 5u);
  EXPECT_EQ(context.counts["edges with too few pairs to sample, kept whole"], 1u);
  EXPECT_EQ(run(Matches(), context).size(), 0u);
}

}  // namespace
}  // namespace plumb::prune_ransac
