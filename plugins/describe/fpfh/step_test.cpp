#include "plumb/slam/step.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "scene_for_test.hpp"

namespace plumb::describe_fpfh {
namespace {

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

TEST(DescribeFpfhStep, DescribesEveryPointWhenToldTo) {
  TestContext context;
  Cloud cloud = street_corner(4000, 1);
  cloud.add({100, 100, 100});  // alone
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  cloud.add({5, 5, 0.5f});  // without a normal
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(0);
  StepUnderTest step(*plumb_module());
  step.with("segment", segment_of(cloud)).set("radius", 1.5).set("min_neighbours", std::int64_t{1});
  step.set("keypoint_voxel_size", std::monostate());
  const auto features = step.run<Features>("features", context);
  ASSERT_EQ(features.size(), 4000u);
  EXPECT_EQ(context.counts["keypoints with too few neighbours left out"], 1u);
  for (std::size_t k = 0; k < features.size(); ++k)
    EXPECT_EQ(features.points[k], cloud.point(k)) << k;
  // A keypoint has the feature that it has among few.
  step.set("keypoint_voxel_size", 0.8);
  const auto few = step.run<Features>("features", context);
  std::size_t k = 0;
  for (std::size_t n = 0; n < few.size(); ++n, ++k) {
    while (k < features.size() && features.points[k] != few.points[n]) ++k;
    ASSERT_LT(k, features.size());
    EXPECT_TRUE(std::equal(few.vector(n), few.vector(n) + 33, features.vector(k))) << n;
    EXPECT_EQ(few.at_border[n], features.at_border[k]) << n;
  }
  EXPECT_GT(few.size(), 200u);
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
  StepUnderTest step(*plumb_module());
  step.with("segment", segment_of(cloud));
  EXPECT_THAT(io::refusal([&] { step.run<Features>("features", context); }),
              testing::HasSubstr("estimate.normals"));
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
