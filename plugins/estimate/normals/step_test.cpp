#include "plumb/slam/step.hpp"

#include "plumb/plugin/step_testing.hpp"

namespace plumb::estimate_normals {
namespace {

/// A horizontal patch, seen by frame 0 from above (even points) and by frame 1 from below (odd
/// points), and an outlier.
Segment patch() {
  Cloud cloud;
  std::vector<std::uint16_t> frames;
  for (int k = 0; k < 400; ++k) {
    cloud.add({0.2f * static_cast<float>(k % 20), 0.2f * static_cast<float>(k / 20), 0});
    frames.push_back(static_cast<std::uint16_t>(k % 2));
  }
  cloud.add({50, 50, 0});
  frames.push_back(0);
  Segment segment;
  segment.range.end = 2;
  segment.range.T_segment_frame = {Pose(Eigen::Quaterniond::Identity(), {2, 2, 3}),
                                   Pose(Eigen::Quaterniond::Identity(), {2, 2, -3})};
  return segment.with(std::move(cloud), std::move(frames));
}

TEST(EstimateNormalsStep, TurnsEachNormalToTheSensorOfItsOwnFrame) {
  TestContext context;
  const auto result =
      StepUnderTest(*plumb_module()).with("segment", patch()).run<Segment>("segment", context);
  ASSERT_EQ(result.cloud.size(), 401u);
  for (std::size_t k = 0; k < 400; ++k) EXPECT_NEAR(result.cloud.nz[k], k % 2 ? -1 : 1, 1e-5);
  EXPECT_TRUE(result.cloud.normal(400).isZero());
  EXPECT_EQ(context.counts["points without a normal"], 1u);
}

TEST(EstimateNormalsStep, GivesNoNormalWhereTheSharesAreNotMet) {
  // Rows 2 m apart, points 0.2 m: within 1 m of a point lies its own row only, with 1 cm of noise
  // to its sides.
  Random random(1);
  Segment rows = patch();
  for (std::size_t k = 0; k < 400; ++k)
    rows.cloud.y[k] = 10 * rows.cloud.y[k] + 0.02f * static_cast<float>(random.uniform() - 0.5);
  rows = rows.with(rows.cloud, rows.frame);
  for (const bool wide : {false, true}) {
    TestContext context;
    StepUnderTest step(*plumb_module());
    step.with("segment", rows);
    if (wide) step.set("min_width", 0.2);
    step.run<Segment>("segment", context);
    EXPECT_EQ(context.counts["points without a normal"], wide ? 401u : 1u);
  }
}

TEST(EstimateNormalsStep, RefusesANeighbourhoodWithoutBounds) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("segment", patch())
      .set("radius", std::monostate())
      .set("max_neighbours", std::monostate());
  EXPECT_THROW(step.run<Segment>("segment", context), Error);
}

}  // namespace
}  // namespace plumb::estimate_normals
