#include <gtest/gtest.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::prune_distance {
namespace {

/// Pairs along x that are 0, 1, 2, ... m apart under the identity.
Matches pairs_apart(int count) {
  Matches m;
  for (int k = 0; k < count; ++k) {
    m.p.push_back({static_cast<float>(k), 7, 0});
    m.q.push_back({0, 7, 0});
    m.weight.push_back(1);
  }
  m.found = static_cast<std::uint32_t>(count);
  return m;
}

TEST(DistanceGate, KeepsPairsUpToAndWithTheLimitUnderThePresentPoses) {
  const Pose two_ahead(Eigen::Quaterniond::Identity(), {2, 0, 0});
  TestContext context;
  const auto kept = StepUnderTest(*plumb_module())
                        .with("matches", pairs_apart(6))
                        .part("poses", two_ahead)
                        .set("max_correspondence_distance", 1.0)
                        .run<Matches>("matches", context);
  ASSERT_EQ(kept.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(kept.p[k].x(), static_cast<float>(k + 1));
}

TEST(DistanceGate, OpensForLoopsByTheirCentroidDistance) {
  StepUnderTest step(*plumb_module());
  step.with("matches", pairs_apart(10))
      .part("poses", Pose())
      .set("max_correspondence_distance", 1.0)
      .set("loop_margin", 2.0);
  TestContext context;
  step.part("edges", Edge{0, 5, EdgeKind::loop, 0.5f, 4.0f});
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 7u);
  EXPECT_EQ(context.counts["pairs dropped"], 3u);
  step.part("edges", Edge{0, 1, EdgeKind::sequential, 1.0f, 4.0f});
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 2u);
}

TEST(DistanceGate, RefusesALoopMarginWithoutEdges) {
  StepUnderTest step(*plumb_module());
  step.with("matches", pairs_apart(3)).part("poses", Pose()).set("loop_margin", 2.0);
  TestContext context;
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

TEST(DistanceGate, LetsNoPairsThrough) {
  TestContext context;
  const auto kept = StepUnderTest(*plumb_module())
                        .with("matches", Matches())
                        .part("poses", Pose())
                        .run<Matches>("matches", context);
  EXPECT_EQ(kept.size(), 0u);
}

TEST(DistanceGate, RemembersHowManyWereFound) {
  TestContext context;
  const auto kept = StepUnderTest(*plumb_module())
                        .with("matches", pairs_apart(9))
                        .part("poses", Pose())
                        .run<Matches>("matches", context);
  EXPECT_EQ(kept.size(), 4u);
  EXPECT_EQ(kept.found, 9u);
}

}  // namespace
}  // namespace plumb::prune_distance
