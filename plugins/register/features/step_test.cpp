#include "plumb/slam/step.hpp"

#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/values.hpp"
#include "yard_testing.hpp"

namespace plumb::register_features {
namespace {

const Pose T_world_i(exp_rotation({0.01, -0.02, 0.3}), {2, -1, 1.5}),
    T_world_j(exp_rotation({-0.02, 0.01, 2.0}), {-3, 2, 1.8});
const Pose T_i_j = T_world_i.inverse() * T_world_j;

/// `right` keypoints of the yard as both segments see them, 0.1 m off, and `wrong` pairs of
/// different points.
Matches planted(int right, int wrong, const Pose& T_i_j_planted, std::uint32_t seed) {
  const Cloud world = yard(1);
  std::mt19937 random(seed);
  std::normal_distribution<float> error(0, 0.1f);
  const auto any = [&] {
    return Eigen::Vector3f(Motion(T_world_i.inverse()) * world.point(random() % world.size()));
  };
  const Motion to_j(T_i_j_planted.inverse());
  Matches m;
  for (int k = 0; k < right + wrong; ++k) {
    m.p.push_back(any());
    m.q.push_back(to_j * (k < right ? m.p.back() : any()));
    for (int axis = 0; axis < 3; ++axis) m.q.back()[axis] += error(random);
  }
  m.found = static_cast<std::uint32_t>(right + wrong);
  return m;
}

StepUnderTest registering(const Matches& matches, const Segment& i, const Segment& j) {
  StepUnderTest step(*plumb_module());
  step.with("matches", matches).ends("segments", i, j);
  return step;
}

TEST(RegisterFeatures, RegistersSegmentsWithoutAnyStartFromMatchesThatAreMostlyWrong) {
  const Segment i = seen_from(T_world_i, yard(2)), j = seen_from(T_world_j, yard(3));
  TestContext context;
  const auto found =
      registering(planted(30, 170, T_i_j, 1), i, j).run<Registration>("registration", context);
  EXPECT_TRUE(found.accepted);
  const Pose error = T_i_j.inverse() * found.T_i_j;
  EXPECT_LT(error.translation.norm(), 0.02);
  EXPECT_LT(angle(error), 0.002);
  EXPECT_GT(found.overlap, 0.8f);
  EXPECT_FALSE(found.information.isZero(0));
  EXPECT_EQ(context.counts["edges registered"], 1u);
}

TEST(RegisterFeatures, AcceptsNothingWhereMatchesAgreeOnNoMotion) {
  const Segment i = seen_from(T_world_i, yard(2)), j = seen_from(T_world_j, yard(3));
  for (const Matches& matches : {planted(0, 200, T_i_j, 1), planted(8, 0, T_i_j, 1), Matches()}) {
    TestContext context;
    EXPECT_FALSE(registering(matches, i, j).run<Registration>("registration", context).accepted);
    EXPECT_EQ(context.counts["edges whose matches agree on no motion"], 1u);
  }
}

TEST(RegisterFeatures, AcceptsNoMotionThatTheCloudsContradict) {
  const Segment i = seen_from(T_world_i, yard(2)), j = seen_from(T_world_j, yard(3));
  const Pose wrong = Pose(exp_rotation({0, 0, 1}), {5, 5, 4}) * T_i_j;  // 30 matches agree about it
  TestContext context;
  const auto found =
      registering(planted(30, 70, wrong, 1), i, j).run<Registration>("registration", context);
  EXPECT_FALSE(found.accepted);
  EXPECT_LT(found.overlap, 0.25f);
  EXPECT_EQ(context.counts["edges whose clouds do not overlap enough after alignment"], 1u);
}

TEST(RegisterFeatures, AcceptsNothingBetweenEmptySegments) {
  TestContext context;
  EXPECT_FALSE(registering(planted(30, 0, T_i_j, 1), Segment(), Segment())
                   .run<Registration>("registration", context)
                   .accepted);
}

/// A room a tenth as large, with 'scale' 0.1, is registered as the large one.
TEST(RegisterFeatures, MultipliesItsLengthsByTheScale) {
  const double size = 0.1;
  const auto small = [&](Cloud cloud) {
    for (auto* axis : {&cloud.x, &cloud.y, &cloud.z})
      for (float& v : *axis) v *= static_cast<float>(size);
    return cloud;
  };
  const Segment i = seen_from(T_world_i, yard(2)), j = seen_from(T_world_j, yard(3));
  Matches matches = planted(30, 170, T_i_j, 1);
  TestContext context;
  const auto large = registering(matches, i, j).run<Registration>("registration", context);
  for (auto* points : {&matches.p, &matches.q})
    for (auto& p : *points) p *= static_cast<float>(size);
  const auto found = registering(matches, segment_of(small(i.cloud)), segment_of(small(j.cloud)))
                         .with("scale", Metrics().add("scale", size, ""))
                         .run<Registration>("registration", context);
  EXPECT_TRUE(found.accepted);
  EXPECT_NEAR(found.overlap, large.overlap, 0.01f);
  EXPECT_LT((found.T_i_j.translation - size * large.T_i_j.translation).norm(), 0.001);
}

TEST(RegisterFeatures, GivesTheSameForAnySeed) {
  const Segment i = seen_from(T_world_i, yard(2)), j = seen_from(T_world_j, yard(3));
  const Matches matches = planted(30, 170, T_i_j, 1);
  TestContext a(1), b(2);
  const auto once = registering(matches, i, j).run<Registration>("registration", a);
  const auto again = registering(matches, i, j).run<Registration>("registration", b);
  EXPECT_EQ(once.T_i_j.translation, again.T_i_j.translation);
  EXPECT_EQ(once.information, again.information);
}

TEST(RegisterFeatures, SaysThatItNeedsNormals) {
  const Segment i = seen_from(T_world_i, yard(2));
  Cloud bare = yard(3);
  bare.nx.clear(), bare.ny.clear(), bare.nz.clear();
  const Segment j = segment_of(bare);
  for (const auto& [a, b] : {std::pair(i, j), std::pair(j, i)}) {
    TestContext context;
    const auto step = registering(planted(30, 0, T_i_j, 1), a, b);
    EXPECT_THAT(io::refusal([&] { step.run<Registration>("registration", context); }),
                testing::AllOf(testing::HasSubstr("have no normals"),
                               testing::HasSubstr("estimate.normals")));
  }
}

}  // namespace
}  // namespace plumb::register_features
