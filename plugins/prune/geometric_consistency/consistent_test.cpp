#include "consistent.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/pairs_testing.hpp"

namespace plumb::prune_geometric_consistency {
namespace {

using pcl::planted;
using pcl::right_of;
using testing::ElementsAre;
using testing::IsEmpty;

/// A motion that no current pose comes near.
const Pose far_off(exp_rotation({0.1, -0.2, 2.5}), {25, -14, 2});

TEST(GeometricConsistency, FindsTheRightPairsWithoutAPose) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const auto kept = largest_consistent(planted(40, 160, far_off, 10, seed), {}, {});
    EXPECT_GE(right_of(kept, 40), 36u) << seed;
    EXPECT_LE(kept.size() - right_of(kept, 40), 2u) << seed;
    EXPECT_TRUE(std::ranges::is_sorted(kept));
  }
}

TEST(GeometricConsistency, KeepsPairsThatAreConsistentWithEachOther) {
  const Matches matches = planted(60, 100, far_off, 5, 6);
  const auto kept = largest_consistent(matches, far_off, {.gc_size = 0.4});
  ASSERT_GE(kept.size(), 40u);
  for (const auto a : kept)
    for (const auto b : kept)
      EXPECT_LE(
          std::abs((matches.p[a] - matches.p[b]).norm() - (matches.q[a] - matches.q[b]).norm()),
          0.401f);
}

TEST(GeometricConsistency, TakesTheLargerOfTwoMotions) {
  Matches matches = planted(30, 0, far_off, 1, 7);
  const Matches others = planted(50, 0, Pose(), 1, 8);
  matches.p.insert(matches.p.end(), others.p.begin(), others.p.end());
  matches.q.insert(matches.q.end(), others.q.begin(), others.q.end());
  const auto kept = largest_consistent(matches, far_off, {});
  EXPECT_EQ(right_of(kept, 30), 0u);
  EXPECT_GE(kept.size(), 45u);
}

TEST(GeometricConsistency, GivesTheSameAgain) {
  const Matches matches = planted(50, 250, far_off, 8, 9);
  EXPECT_EQ(largest_consistent(matches, far_off, {}), largest_consistent(matches, far_off, {}));
}

TEST(GeometricConsistency, FindsNothingAmongPairsThatAgreeOnNothing) {
  EXPECT_THAT(largest_consistent(planted(0, 40, Pose(), 30, 10), {}, {.gc_size = 0.1}), IsEmpty());
  EXPECT_THAT(largest_consistent(Matches(), {}, {}), IsEmpty());
}

Matches run(const Matches& matches, TestContext& context) {
  return StepUnderTest(*plumb_module())
      .with("matches", matches)
      .part("poses", Pose())
      .run<Matches>("matches", context);
}

TEST(GeometricConsistencyStep, HasThePortsOfKMeans) {
  TestContext context;
  const Matches kept = run(planted(40, 60, far_off, 10, 11), context);
  EXPECT_GE(right_of(kept.index_p, 40), 36u);
  EXPECT_EQ(kept.found, 100u);
  EXPECT_EQ(context.counts["pairs dropped"], 100 - kept.size());
}

TEST(GeometricConsistencyStep, KeepsFewPairsAsTheyAreAndTellsOfNone) {
  TestContext context;
  EXPECT_THAT(run(planted(2, 3, far_off, 10, 12), context).index_p, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(context.counts["edges with too few pairs to group, kept whole"], 1u);
  EXPECT_EQ(run(planted(0, 12, Pose(), 30, 13), context).size(), 0u);
  EXPECT_EQ(context.counts["edges without a consistent set of pairs"], 1u);
  EXPECT_EQ(run(Matches(), context).size(), 0u);
}

}  // namespace
}  // namespace plumb::prune_geometric_consistency
