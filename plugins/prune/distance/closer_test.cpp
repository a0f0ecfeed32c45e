#include "closer.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"

namespace plumb {
namespace {

using testing::ElementsAre;

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

TEST(DistanceGate, KeepsPairsUpToAndWithTheLimit) {
  EXPECT_THAT(closer(pairs_apart(6), Pose(), 3), ElementsAre(0, 1, 2, 3));
}

TEST(DistanceGate, MeasuresUnderThePresentPoses) {
  const Pose two_ahead(Eigen::Quaterniond::Identity(), {2, 0, 0});
  EXPECT_THAT(closer(pairs_apart(6), two_ahead, 1), ElementsAre(1, 2, 3));
}

TEST(DistanceGate, OpensForLoopsByTheirCentroidDistance) {
  StepRun step(*plumb_module());
  step.with("matches", pairs_apart(10))
      .at("poses", Pose())
      .set("max_correspondence_distance", 1.0)
      .set("loop_margin", 2.0);
  TestContext context;
  step.edge("edges", {0, 5, EdgeKind::loop, 0.5f, 4.0f});
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 7u);
  EXPECT_EQ(context.counts["pairs dropped"], 3u);
  step.edge("edges", {0, 1, EdgeKind::sequential, 1.0f, 4.0f});
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 2u);
}

TEST(DistanceGate, RefusesALoopMarginWithoutEdges) {
  StepRun step(*plumb_module());
  step.with("matches", pairs_apart(3)).at("poses", Pose()).set("loop_margin", 2.0);
  TestContext context;
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

TEST(DistanceGate, LetsNoPairsThrough) {
  TestContext context;
  const auto kept = StepRun(*plumb_module())
                        .with("matches", Matches())
                        .at("poses", Pose())
                        .run<Matches>("matches", context);
  EXPECT_EQ(kept.size(), 0u);
}

TEST(DistanceGate, RemembersHowManyWereFound) {
  TestContext context;
  const auto kept = StepRun(*plumb_module())
                        .with("matches", pairs_apart(9))
                        .at("poses", Pose())
                        .run<Matches>("matches", context);
  EXPECT_EQ(kept.size(), 4u);
  EXPECT_EQ(kept.found, 9u);
}

}  // namespace
}  // namespace plumb
