#include "harris3d.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::keypoints_harris3d {
namespace {

using pcl::segment_of;
using pcl::street_corner;
using testing::IsEmpty;

bool within(const Cloud& cloud, std::size_t a, std::size_t b, double radius) {
  return (cloud.point(a) - cloud.point(b)).squaredNorm() <= radius * radius;
}

double response(const Cloud& cloud, std::size_t k, const HarrisOptions& options) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t m = 0; m < cloud.size(); ++m) {
    if (!within(cloud, k, m, options.radius)) continue;
    const Eigen::Vector3d n = cloud.normal(m).cast<double>();
    moments += n * n.transpose();
    ++count;
  }
  moments /= count;
  if (options.response == Response::harris) return moments.determinant();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvalues()[0];
}

/// What the response of point k exceeds the largest one round it by.
double lead(const Cloud& cloud, const std::vector<double>& responses, std::size_t k,
            double radius) {
  double largest = -1;
  for (std::size_t m = 0; m < cloud.size(); ++m)
    if (m != k && within(cloud, k, m, radius)) largest = std::max(largest, responses[m]);
  return responses[k] - largest;
}

TEST(Harris3d, FindsTheStrongestPointsOfTheirNeighbourhoods) {
  const Cloud cloud = street_corner(2500, 1);
  for (const Response kind : {Response::harris, Response::tomasi}) {
    const HarrisOptions options{.response = kind, .threshold = 0.01};
    const auto kept = harris3d(cloud, options);
    EXPECT_GE(kept.size(), 3u);
    EXPECT_LT(kept.size(), 100u);
    std::vector<double> responses(cloud.size());
    for (std::size_t k = 0; k < cloud.size(); ++k) responses[k] = response(cloud, k, options);
    for (std::uint32_t k = 0; k < cloud.size(); ++k) {
      const double leads = lead(cloud, responses, k, options.radius);
      if (std::ranges::binary_search(kept, k)) {
        EXPECT_GE(responses[k], 0.01 - 1e-4);
        EXPECT_GT(leads, -1e-4);
      } else {
        EXPECT_FALSE(responses[k] > 0.01 + 1e-4 && leads > 1e-4) << k;
      }
    }
  }
}

TEST(Harris3d, FindsTheCornersOfABoxAndNothingElse) {
  Random random(2);
  Cloud cloud;
  const auto uniform = [&] { return static_cast<float>(4 * random.uniform()); };
  for (int k = 0; k < 6000; ++k) {
    const int axis = k % 3;
    Eigen::Vector3f p, n = Eigen::Vector3f::Zero();
    p[axis] = k % 2 ? 4.f : 0.f;
    p[(axis + 1) % 3] = uniform(), p[(axis + 2) % 3] = uniform();
    n[axis] = k % 2 ? 1.f : -1.f;
    cloud.add(p);
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  }
  const auto kept = harris3d(cloud, {.radius = 0.8});
  const auto distance = [&](std::uint32_t k, int corner) {
    const Eigen::Vector3f at(corner & 1 ? 4.f : 0.f, corner & 2 ? 4.f : 0.f,
                             corner & 4 ? 4.f : 0.f);
    return (cloud.point(k) - at).norm();
  };
  for (int corner = 0; corner < 8; ++corner)
    EXPECT_TRUE(std::ranges::any_of(kept, [&](auto k) { return distance(k, corner) < 0.5f; }));
  for (const auto k : kept) {
    float nearest = 10;
    for (int corner = 0; corner < 8; ++corner) nearest = std::min(nearest, distance(k, corner));
    EXPECT_LT(nearest, 0.8f);
  }
}

TEST(Harris3d, PassesOverPointsWithoutNormals) {
  Cloud cloud = street_corner(2500, 3);
  const auto kept = harris3d(cloud, {});
  for (int k = 0; k < 50; ++k) {
    cloud.add(cloud.point(static_cast<std::size_t>(k)));
    cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(0);
  }
  EXPECT_EQ(harris3d(cloud, {}), kept);
  EXPECT_THAT(harris3d(Cloud(), {}), IsEmpty());
}

TEST(KeypointsHarris3dStep, GivesThePointsWithAllThatIsKnownOfThem) {
  const Cloud cloud = street_corner(2500, 4);
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("segment", segment_of(cloud)).set("response", std::string("tomasi")).set("radius", 1.2);
  const auto keypoints = step.run<Segment>("keypoints", context);
  const auto kept = harris3d(cloud, {.response = Response::tomasi, .radius = 1.2});
  EXPECT_EQ(keypoints.cloud.x, select(cloud, kept).x);
  EXPECT_TRUE(keypoints.cloud.has_normals());
  EXPECT_EQ(context.counts["keypoints"], kept.size());
  Cloud bare;
  for (int k = 0; k < 10; ++k) bare.add({static_cast<float>(k), 0, 0});
  step.with("segment", segment_of(bare));
  EXPECT_THROW(step.run<Segment>("keypoints", context), Error);
}

}  // namespace
}  // namespace plumb::keypoints_harris3d
