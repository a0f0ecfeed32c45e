#include "shot.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::describe_shot {
namespace {

using pcl::segment_of;
using pcl::street_corner;
using testing::ElementsAre;

constexpr ShotOptions near{.radius = 1.5};

std::vector<std::uint32_t> every(std::size_t count, std::size_t nth) {
  std::vector<std::uint32_t> keys;
  for (std::size_t k = 0; k < count; k += nth) keys.push_back(static_cast<std::uint32_t>(k));
  return keys;
}

double distance(const Features& a, std::size_t i, const Features& b, std::size_t j) {
  double sum = 0;
  for (std::size_t d = 0; d < shot_size; ++d)
    sum += (a.vector(i)[d] - b.vector(j)[d]) * (a.vector(i)[d] - b.vector(j)[d]);
  return std::sqrt(sum);
}

TEST(Shot, GivesVectorsOfLengthOne) {
  const Cloud cloud = street_corner(4000, 1);
  const auto result = shot(cloud, every(4000, 40), near);
  ASSERT_EQ(result.features.size(), 100u);
  EXPECT_EQ(result.index, every(4000, 40));
  for (std::size_t k = 0; k < 100; ++k) {
    const float* v = result.features.vector(k);
    EXPECT_NEAR(std::inner_product(v, v + shot_size, v, 0.0), 1, 1e-4);
    EXPECT_GE(*std::min_element(v, v + shot_size), 0);
    EXPECT_EQ(result.features.points[k], cloud.point(40 * k));
    EXPECT_EQ(result.features.normals[k], cloud.normal(40 * k));
  }
}

TEST(Shot, DoesNotSeeHowTheCloudLies) {
  const Cloud cloud = street_corner(4000, 2);
  const Cloud elsewhere = pcl::moved(cloud, Pose(exp_rotation({0.4, -0.3, 2.1}), {20, -9, 3}));
  const auto here = shot(cloud, every(4000, 20), near).features,
             there = shot(elsewhere, every(4000, 20), near).features;
  ASSERT_EQ(here.size(), there.size());
  std::size_t same = 0;
  for (std::size_t k = 0; k < here.size(); ++k) same += distance(here, k, there, k) < 0.05;
  EXPECT_GE(same, here.size() * 95 / 100);
}

TEST(Shot, TellsPlacesApart) {
  const Cloud cloud = street_corner(6000, 3);
  std::vector<std::uint32_t> keys;  // by the pillar, in the corner, on the open ground
  for (const Eigen::Vector3f& at :
       {Eigen::Vector3f(7.4f, 4, 1), Eigen::Vector3f(0, 0, 2), Eigen::Vector3f(9, 9, 0)}) {
    const auto nearer = [&](std::size_t a, std::size_t b) {
      return (cloud.point(a) - at).norm() < (cloud.point(b) - at).norm();
    };
    std::uint32_t best = 0;
    for (std::uint32_t k = 1; k < cloud.size(); ++k)
      if (nearer(k, best)) best = k;
    keys.push_back(best);
  }
  const auto features = shot(cloud, keys, near).features;
  ASSERT_EQ(features.size(), 3u);
  EXPECT_GT(distance(features, 0, features, 1), 0.4);
  EXPECT_GT(distance(features, 0, features, 2), 0.4);
  EXPECT_GT(distance(features, 1, features, 2), 0.4);
}

TEST(Shot, MarksWhereTheCloudEnds) {
  const Cloud cloud = street_corner(6000, 4, 0.005f);
  const auto result = shot(cloud, every(6000, 1), near);
  std::size_t inner = 0, wrong = 0;
  for (std::size_t k = 0; k < result.features.size(); ++k) {
    const Eigen::Vector3f p = result.features.points[k];
    const bool open_ground = std::abs(p.z()) < 0.01f && p.x() > 9 && p.y() > 9;
    if (open_ground && p.x() > 11.9f) {
      EXPECT_EQ(result.features.at_border[k], 1) << p.transpose();
    }
    if (open_ground && p.x() < 10.5f && p.y() < 10.5f)
      ++inner, wrong += result.features.at_border[k];
  }
  EXPECT_GT(inner, 20u);
  EXPECT_LE(wrong, inner / 10);
}

TEST(Shot, LeavesOutWhatHasNoFrameOrNoNormal) {
  Cloud cloud = street_corner(4000, 5);
  cloud.add({100, 100, 100});
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  cloud.nx[7] = cloud.ny[7] = cloud.nz[7] = 0;
  const auto result = shot(cloud, {7, 9, 4000}, near);
  EXPECT_THAT(result.index, ElementsAre(9));
  EXPECT_EQ(result.features.size(), 1u);
  EXPECT_EQ(result.left_out, 2u);
  EXPECT_EQ(shot(Cloud(), {}, near).features.size(), 0u);
}

TEST(DescribeShotStep, DescribesOneAVoxelOrTheKeypointsThatAreWired) {
  TestContext context;
  const Cloud cloud = street_corner(4000, 6);
  StepUnderTest step(*plumb_module());
  step.with("segment", segment_of(cloud)).set("radius", 1.5).set("keypoint_voxel_size", 1.0);
  const auto all = step.run<Features>("features", context);
  EXPECT_EQ(all.dimension, 352u);
  EXPECT_GT(all.size(), 150u);
  EXPECT_EQ(context.counts["keypoints without a local reference frame left out"], 0u);
  const std::vector<std::uint32_t> chosen{3, 333, 3333};
  const auto few =
      step.with("keypoints", segment_of(select(cloud, chosen))).run<Features>("features", context);
  ASSERT_EQ(few.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(few.points[k], cloud.point(chosen[k]));
}

TEST(DescribeShotStep, RefusesASegmentWithoutNormalsAndNamesTheCure) {
  Cloud bare;
  for (int k = 0; k < 10; ++k) bare.add({static_cast<float>(k), 0, 0});
  TestContext context;
  try {
    StepUnderTest(*plumb_module())
        .with("segment", segment_of(bare))
        .run<Features>("features", context);
    FAIL() << "not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("estimate.normals"));
  }
}

}  // namespace
}  // namespace plumb::describe_shot
