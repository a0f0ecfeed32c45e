#include "vfh.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::describe_vfh {
namespace {

/// A street corner whose normals are a little off, as estimated ones are.
Cloud scene(std::size_t count, std::uint64_t seed) {
  Cloud cloud = pcl::street_corner(count, seed);
  Random random(seed + 100);
  const auto off = [&] { return static_cast<float>(0.1 * (random.uniform() - 0.5)); };
  for (std::size_t k = 0; k < count; ++k) {
    const float x = off(), y = off(), z = off();
    const Eigen::Vector3f n = (cloud.normal(k) + Eigen::Vector3f(x, y, z)).normalized();
    cloud.nx[k] = n.x(), cloud.ny[k] = n.y(), cloud.nz[k] = n.z();
  }
  return cloud;
}

double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(a[k] - b[k]);
  return sum;
}

/// Numbers first .. end - 1, scaled to the sum 1.
std::vector<float> part(const std::vector<float>& values, std::size_t first, std::size_t end) {
  std::vector<float> result(values.begin() + static_cast<long>(first),
                            values.begin() + static_cast<long>(end));
  const float sum = std::accumulate(result.begin(), result.end(), 0.0f);
  for (auto& value : result) value /= sum;
  return result;
}

/// Shares of `values`, from 0 to 1, in so many bins.
std::vector<float> histogram(const std::vector<double>& values, std::size_t bins) {
  std::vector<float> result(bins, 0);
  for (const double value : values)
    result[std::min(static_cast<std::size_t>(value * static_cast<double>(bins)), bins - 1)] +=
        1.0f / static_cast<float>(values.size());
  return result;
}

constexpr VfhOptions from_above{.viewpoint = Viewpoint::above};

TEST(Vfh, SumsToOneAndHasNoNegativeNumber) {
  const auto values = vfh(scene(3000, 1), {}).value();
  ASSERT_EQ(values.size(), 308u);
  EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 1, 1e-5);
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0);
  EXPECT_EQ(std::accumulate(values.begin() + 135, values.begin() + 180, 0.0f), 0);
}

TEST(Vfh, CountsHowTheNormalsLieToTheViewpoint) {
  const Cloud cloud = pcl::moved(scene(3000, 2), Pose(Eigen::Quaterniond::Identity(), {3, 2, 1}));
  const Eigen::Vector3f centroid = centroid_of(cloud);
  for (const Viewpoint viewpoint : {Viewpoint::origin, Viewpoint::above}) {
    const Eigen::Vector3f to = viewpoint == Viewpoint::above
                                   ? Eigen::Vector3f(0, 0, 1)
                                   : Eigen::Vector3f(-centroid.normalized());
    std::vector<double> cosines;
    for (std::size_t k = 0; k < cloud.size(); ++k)
      cosines.push_back(0.5 * (1 + cloud.normal(k).dot(to)));
    const auto values = vfh(cloud, {.viewpoint = viewpoint}).value();
    EXPECT_LT(difference(part(values, 180, 308), histogram(cosines, 128)), 0.01);
  }
}

TEST(Vfh, CountsDistancesFromTheCentroidWhereAsked) {
  const Cloud cloud = scene(3000, 3);
  const Eigen::Vector3f centroid = centroid_of(cloud);
  std::vector<double> distances;
  for (std::size_t k = 0; k < cloud.size(); ++k)
    distances.push_back((cloud.point(k) - centroid).norm());
  const double most = *std::max_element(distances.begin(), distances.end());
  for (auto& d : distances) d /= most;
  const auto values = vfh(cloud, {.distances = true}).value();
  EXPECT_LT(difference(part(values, 135, 180), histogram(distances, 45)), 0.01);
}

TEST(Vfh, DoesNotSeeHowTheCloudLiesRoundTheViewpoint) {
  const Cloud cloud = scene(3000, 4);
  const Cloud tilted = pcl::moved(cloud, Pose(exp_rotation({0.5, -0.8, 1.2}), {0, 0, 0}));
  const Cloud elsewhere = pcl::moved(cloud, Pose(exp_rotation({0, 0, 2.2}), {30, -20, 5}));
  EXPECT_LT(difference(vfh(cloud, {}).value(), vfh(tilted, {}).value()), 0.02);
  EXPECT_LT(difference(vfh(cloud, from_above).value(), vfh(elsewhere, from_above).value()), 0.02);
}

TEST(Vfh, TellsShapesApartAndKnowsThemAgain) {
  const auto once = vfh(scene(3000, 5), from_above).value(),
             again = vfh(scene(3000, 6), from_above).value();
  Cloud ground;
  Random random(7);
  for (int k = 0; k < 3000; ++k) {
    const auto x = static_cast<float>(12 * random.uniform()),
               y = static_cast<float>(12 * random.uniform());
    ground.add({x, y, 0});
    ground.nx.push_back(0), ground.ny.push_back(0), ground.nz.push_back(1);
  }
  const auto plane = vfh(ground, from_above).value();
  EXPECT_NEAR(plane[307], 0.25, 1e-3);  // all normals look up
  EXPECT_LT(difference(once, again), 0.3);
  EXPECT_GT(difference(once, plane), 0.8);
}

TEST(Vfh, PassesOverPointsWithoutNormals) {
  Cloud cloud = scene(1000, 8);
  const auto values = vfh(cloud, {}).value();
  cloud.add({50, 50, 50});
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(0);
  EXPECT_EQ(values, vfh(cloud, {}).value());
}

TEST(Vfh, IsNothingWithoutAShape) {
  EXPECT_FALSE(vfh(Cloud(), {}));
  EXPECT_FALSE(vfh(scene(2, 1), {}));
  Cloud bare;
  bare.add({1, 2, 3});
  EXPECT_THROW(vfh(bare, {}), Error);
}

TEST(DescribeVfhStep, GivesADescriptorAsEsfDoes) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  const Cloud cloud = scene(2000, 9);
  const auto found = step.with("segment", pcl::segment_of(cloud))
                         .set("viewpoint", std::string("above"))
                         .run<Descriptor>("descriptor", context);
  EXPECT_EQ(found.values, vfh(cloud, from_above).value());
  EXPECT_TRUE(context.warnings.empty());
  const auto none = step.with("segment", Segment()).run<Descriptor>("descriptor", context);
  EXPECT_EQ(none.values, std::vector<float>(308, 0.0f));
  EXPECT_EQ(context.warnings.size(), 1u);
}

}  // namespace
}  // namespace plumb::describe_vfh
