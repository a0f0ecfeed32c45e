#include "plumb/slam/step.hpp"

#include "plumb/plugin/step_testing.hpp"
#include "scene_for_test.hpp"

namespace plumb::describe_fpfh {
namespace {

Segment segment_of(Cloud cloud) {
  std::vector<std::uint16_t> frames(cloud.size(), 0);
  return Segment().with(std::move(cloud), std::move(frames));
}

TEST(DescribeFpfhStep, GivesKeyPointsWithHistogramsNormalsAndBorderMarks) {
  TestContext context;
  Cloud cloud = street_corner(4000, 1);
  cloud.add({100, 100, 100});
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  const auto features = StepUnderTest(*plumb_module())
                            .with("segment", segment_of(cloud))
                            .set("radius", 1.5)
                            .run<Features>("features", context);
  EXPECT_EQ(features.dimension, 33u);
  EXPECT_GT(features.size(), 200u);
  EXPECT_LT(features.size(), 1000u);
  EXPECT_EQ(context.counts["keypoints with too few neighbours left out"], 1u);
  // The ground ends at 12 m on two sides.
  for (std::size_t k = 0; k < features.size(); ++k) {
    const bool on_the_end =
        std::abs(features.points[k].z()) < 0.1f && features.points[k].x() > 11.8f;
    if (on_the_end) {
      EXPECT_EQ(features.at_border[k], 1);
    }
  }
}

TEST(DescribeFpfhStep, DescribesTheKeypointsThatAreWired) {
  TestContext context;
  const Cloud cloud = street_corner(4000, 2);
  StepUnderTest step(*plumb_module());
  step.with("segment", segment_of(cloud)).set("radius", 1.5).set("keypoint_voxel_size", 0.3);
  const auto all = step.run<Features>("features", context);
  const std::vector<std::uint32_t> chosen{5, 100, 2000, 3999};
  const auto few =
      step.with("keypoints", segment_of(select(cloud, chosen))).run<Features>("features", context);
  EXPECT_GT(all.size(), 1000u);
  ASSERT_EQ(few.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(few.points[k], cloud.point(chosen[k]));
}

TEST(DescribeFpfhStep, RefusesASegmentWithoutNormalsAndNamesTheCure) {
  Cloud cloud;
  for (int k = 0; k < 10; ++k) cloud.add({static_cast<float>(k), 0, 0});
  TestContext context;
  try {
    StepUnderTest(*plumb_module())
        .with("segment", segment_of(cloud))
        .run<Features>("features", context);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("estimate.normals"), std::string::npos);
  }
}

TEST(DescribeFpfhStep, GivesNoFeaturesForAnEmptySegment) {
  TestContext context;
  const auto features = StepUnderTest(*plumb_module())
                            .with("segment", segment_of({}))
                            .run<Features>("features", context);
  EXPECT_EQ(features.size(), 0u);
}

}  // namespace
}  // namespace plumb::describe_fpfh
