#include "collect.hpp"

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/planar/planar_pose.hpp"

namespace plumb::constraints_collect {
namespace {

using planar::PlanarPose;

Registration registration(const PlanarPose& motion, bool accepted) {
  Registration r;
  r.T_i_j = in_space(motion);
  r.information.diagonal() << 1, 2, 3, 4, 5, 6;
  r.accepted = accepted;
  return r;
}

TEST(CollectConstraints, TakesTheAcceptedOnes) {
  const Edges edges{9, {{0, 4}, {1, 7}, {3, 8}}};
  const auto constraints =
      collected(edges,
                std::vector{registration({1, 0, 0}, true), registration({2, 0, 0}, false),
                            registration({3, 0, 0.5}, true)},
                1);
  ASSERT_EQ(constraints.relative.size(), 2u);
  EXPECT_EQ(constraints.relative[1].i, 3u);
  EXPECT_EQ(constraints.relative[1].j, 8u);
  EXPECT_EQ(constraints.relative[1].T_i_j.translation.x(), 3);
  EXPECT_TRUE(constraints.planar);
}

TEST(CollectConstraints, CountsARotationByHalfItsAngle) {
  const auto constraints = collected({2, {{0, 1}}}, std::vector{registration({1, 0, 0}, true)}, 1);
  Vector6d expected;
  expected << 1, 2, 3, 16, 20, 24;
  EXPECT_EQ(Vector6d(constraints.relative[0].information.diagonal()), expected);
}

TEST(CollectConstraints, InflatesStandardDeviations) {
  const Edges edges{2, {{0, 1}}};
  const std::vector given{registration({1, 0, 0}, true)};
  const Matrix6d once = collected(edges, given, 1).relative[0].information;
  EXPECT_LT((once - 9 * collected(edges, given, 3).relative[0].information).norm(), 1e-12);
}

TEST(CollectConstraints, LeavesOutWhatKnowsNothing) {
  auto empty = registration({1, 0, 0}, true);
  empty.information.setZero();
  const auto constraints = collected({2, {{0, 1}}}, std::vector{empty}, 1);
  EXPECT_TRUE(constraints.relative.empty());
  EXPECT_FALSE(constraints.planar);
}

TEST(CollectConstraints, AreNotPlanarWhereAMotionLeavesThePlane) {
  auto tilted = registration({1, 0, 0}, true);
  tilted.T_i_j.translation.z() = 0.1;
  EXPECT_FALSE(
      collected({3, {{0, 1}, {1, 2}}}, std::vector{tilted, registration({1, 0, 0}, true)}, 1)
          .planar);
}

TEST(CollectConstraints, CountWhatTheyTakeAndLeave) {
  TestContext context;
  StepUnderTest(*plumb_module())
      .each("registrations",
            std::vector{registration({1, 0, 0}, true), registration({1, 0, 0}, false)},
            Edges{3, {{0, 1}, {1, 2}}})
      .run<Constraints>("constraints", context);
  EXPECT_EQ(context.counts["registrations accepted"], 1u);
  EXPECT_EQ(context.counts["registrations not accepted and left out"], 1u);
}

}  // namespace
}  // namespace plumb::constraints_collect
