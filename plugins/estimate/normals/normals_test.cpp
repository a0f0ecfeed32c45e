#include "normals.hpp"

#include <gtest/gtest.h>

#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::estimate_normals {
namespace {

Cloud plane(const Eigen::Vector3f& normal, std::size_t count, float noise, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector3f u = normal.unitOrthogonal(), v = normal.cross(u);
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k)
    cloud.add(u * static_cast<float>(random.uniform() * 4) +
              v * static_cast<float>(random.uniform() * 4) +
              normal * noise * static_cast<float>(random.uniform() - 0.5));
  return cloud;
}

std::size_t estimate(Cloud& cloud, const Neighbourhood& of, const Eigen::Vector3f& origin) {
  TestContext context;
  return estimate_normals(
      cloud, SearchTree(cloud), of, [&](std::size_t) { return origin; }, context);
}

TEST(Normals, AreThoseOfAPlane) {
  const Eigen::Vector3f truth = Eigen::Vector3f(1, 2, -3).normalized();
  Cloud cloud = plane(truth, 500, 0, 1);
  EXPECT_EQ(estimate(cloud, {1.0, {}}, 10 * truth), 0u);
  for (std::size_t k = 0; k < cloud.size(); ++k)
    EXPECT_LT((cloud.normal(k) - truth).norm(), 1e-5) << k;
}

TEST(Normals, PointToTheSensor) {
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  Cloud above = plane(up, 300, 0.01f, 2), below = above;
  estimate(above, {{}, 20}, {1, 1, 5});
  estimate(below, {{}, 20}, {1, 1, -5});
  for (std::size_t k = 0; k < above.size(); ++k) {
    EXPECT_GT(above.nz[k], 0.9f);
    EXPECT_EQ(below.normal(k), -above.normal(k));
  }
}

TEST(Normals, OfASphereArePointingAlongItsRadius) {
  Random random(3);
  Cloud cloud;
  for (int k = 0; k < 4000; ++k) {
    const float z = static_cast<float>(2 * random.uniform() - 1);
    const float phi = static_cast<float>(6.2831853 * random.uniform()), r = std::sqrt(1 - z * z);
    cloud.add(5 * Eigen::Vector3f(r * std::cos(phi), r * std::sin(phi), z));
  }
  estimate(cloud, {0.8, 30}, Eigen::Vector3f::Zero());
  for (std::size_t k = 0; k < cloud.size(); ++k)
    EXPECT_LT(cloud.normal(k).dot(cloud.point(k)) / 5, -0.99f) << k;
}

TEST(Normals, AreZeroForOutliersAndForALine) {
  Cloud cloud;
  cloud.add({100, 0, 0});
  cloud.add({100, 0.1f, 0});
  for (int k = 0; k < 50; ++k) cloud.add({0, 0.1f * static_cast<float>(k), 0});
  cloud.add({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  EXPECT_EQ(estimate(cloud, {0.5, 10}, {0, 0, 10}), 53u);
  for (std::size_t k = 0; k < cloud.size(); ++k) EXPECT_TRUE(cloud.normal(k).isZero());
}

TEST(Normals, AreThoseOfAllWithinTheRadiusWhenTheNumberIsOpen) {
  Cloud cloud = plane(Eigen::Vector3f::UnitZ(), 600, 1.0f, 4);
  estimate(cloud, {0.7, {}}, {1, 1, 9});
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    std::vector<Eigen::Vector3f> near;
    for (std::size_t m = 0; m < cloud.size(); ++m)
      if ((cloud.point(m) - cloud.point(k)).norm() <= 0.7f)
        near.push_back(cloud.point(m) - cloud.point(k));
    const Eigen::Vector3f expected = plane_normal(near.data(), near.size());
    EXPECT_NEAR(std::abs(cloud.normal(k).dot(expected)), near.size() < 3 ? 0 : 1, 1e-4) << k;
  }
}

TEST(Normals, AreTheSameForOneAndForFourThreads) {
  Cloud one = plane(Eigen::Vector3f(1, 1, 1).normalized(), 5000, 0.05f, 5), four = one;
  const SearchTree tree(one);
  const auto origin = [](std::size_t) { return Eigen::Vector3f(9, 9, 9); };
  TestContext alone;
  parallel::ThreadedContext together;
  estimate_normals(one, tree, {0.5, 20}, origin, alone);
  estimate_normals(four, tree, {0.5, 20}, origin, together);
  EXPECT_EQ(one.nx, four.nx);
  EXPECT_EQ(one.ny, four.ny);
  EXPECT_EQ(one.nz, four.nz);
}

/// Points along x with noise of `across` [m] in y and z.
Cloud noisy_line(float across) {
  Random random(6);
  Cloud cloud;
  for (int k = 0; k < 600; ++k)
    cloud.add({0.01f * static_cast<float>(k), across * static_cast<float>(2 * random.uniform() - 1),
               across * static_cast<float>(2 * random.uniform() - 1)});
  return cloud;
}
Cloud volume() {
  Random random(7);
  const auto u = [&] { return static_cast<float>(4 * random.uniform()); };
  Cloud cloud;
  for (int k = 0; k < 2000; ++k) {
    const float x = u(), y = u(), z = u();
    cloud.add({x, y, z});
  }
  return cloud;
}
Neighbourhood with_shares(Neighbourhood of, double min_width, double max_thickness) {
  of.min_width = min_width;
  of.max_thickness = max_thickness;
  return of;
}

TEST(Normals, AreZeroAlongANoisyLineWhereAWidthIsAskedFor) {
  Cloud cloud = noisy_line(0.02f);
  const std::size_t all = cloud.size();
  EXPECT_EQ(estimate(cloud, with_shares({0.5, {}}, 0.2, 1), {3, 0, 9}), all);
  for (std::size_t k = 0; k < all; ++k) EXPECT_TRUE(cloud.normal(k).isZero());
  EXPECT_EQ(estimate(cloud, {0.5, {}}, {3, 0, 9}), 0u)
      << "without it noise makes a plane of the line";
}

TEST(Normals, AreZeroInAVolumeWhereAThicknessIsAllowed) {
  Cloud cloud = volume();
  const std::size_t all = cloud.size();
  EXPECT_EQ(estimate(cloud, with_shares({1.0, 200}, 1e-3, 0.3), {2, 2, 20}), all);
  for (std::size_t k = 0; k < all; ++k) EXPECT_TRUE(cloud.normal(k).isZero());
  EXPECT_EQ(estimate(cloud, {1.0, 200}, {2, 2, 20}), 0u) << "without it any volume has normals";
}

TEST(Normals, OfAPlaneAreThereUnderBothShares) {
  Cloud cloud = plane(Eigen::Vector3f(1, 2, -3).normalized(), 2000, 0.02f, 8), before = cloud;
  EXPECT_EQ(estimate(cloud, with_shares({1.0, 60}, 0.2, 0.3), {5, 5, 5}), 0u);
  estimate(before, {1.0, 60}, {5, 5, 5});
  EXPECT_EQ(cloud.nx, before.nx);
  EXPECT_EQ(cloud.ny, before.ny);
  EXPECT_EQ(cloud.nz, before.nz);
}

TEST(PlaneNormal, IsThereFromTheLeastWidthToTheMostThickness) {
  // A box's eight corners: spreads along its axes are its half sides, whose shares are known.
  const auto box = [](float a, float b, float c) {
    std::vector<Eigen::Vector3f> points;
    for (const float x : {-a, a})
      for (const float y : {-b, b})
        for (const float z : {-c, c}) points.emplace_back(x, y, z);
    return points;
  };
  const auto has_one = [](const std::vector<Eigen::Vector3f>& points, double min_width,
                          double max_thickness) {
    return !plane_normal(points.data(), points.size(), min_width, max_thickness).isZero();
  };
  EXPECT_TRUE(has_one(box(1, 0.5f, 0.1f), 0.49, 0.21));
  EXPECT_FALSE(has_one(box(1, 0.5f, 0.1f), 0.51, 0.21)) << "0.5 of the length wide";
  EXPECT_FALSE(has_one(box(1, 0.5f, 0.1f), 0.49, 0.19)) << "0.2 of the width thick";
  EXPECT_TRUE(has_one(box(1, 1, 1), 1e-3, 1)) << "the defaults ask for no surface";
  EXPECT_TRUE(has_one(box(1, 0.0011f, 0), 1e-3, 1));
  EXPECT_FALSE(has_one(box(1, 0.0009f, 0), 1e-3, 1)) << "1 mm on 1 m is a line";
}

TEST(Normals, OfAnEmptyCloudAreEmpty) {
  Cloud cloud;
  EXPECT_EQ(estimate(cloud, {1.0, 30}, {0, 0, 0}), 0u);
  EXPECT_TRUE(cloud.nx.empty());
}

}  // namespace
}  // namespace plumb::estimate_normals
