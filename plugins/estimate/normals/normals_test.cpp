#include "normals.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "plumb/plugin/testing.hpp"

namespace plumb {
namespace {

/// Runs the bodies in four threads, each from the last to the first.
struct ThreadedContext : TestContext {
  void parallel(std::size_t n, const std::function<void(std::size_t)>& body) override {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t)
      threads.emplace_back([&body, n, t] {
        for (std::size_t k = n; k-- > 0;)
          if (k % 4 == t) body(k);
      });
  }
};

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

TEST(Normals, AreZeroForLonelyPointsAndForALine) {
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
  ThreadedContext together;
  estimate_normals(one, tree, {0.5, 20}, origin, alone);
  estimate_normals(four, tree, {0.5, 20}, origin, together);
  EXPECT_EQ(one.nx, four.nx);
  EXPECT_EQ(one.ny, four.ny);
  EXPECT_EQ(one.nz, four.nz);
}

TEST(Normals, OfAnEmptyCloudAreEmpty) {
  Cloud cloud;
  EXPECT_EQ(estimate(cloud, {1.0, 30}, {0, 0, 0}), 0u);
  EXPECT_TRUE(cloud.nx.empty());
}

}  // namespace
TEST(LineNormal, StandsOnTheLineWhateverItsDirection) {
  for (double angle = 0; angle < 3.1; angle += 0.3) {
    std::vector<Eigen::Vector3f> points;
    for (int k = -4; k <= 4; ++k)
      points.emplace_back(0.1 * k * std::cos(angle), 0.1 * k * std::sin(angle), 0);
    const Eigen::Vector3f normal = line_normal(points.data(), points.size());
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
    EXPECT_NEAR(normal.x() * std::cos(angle) + normal.y() * std::sin(angle), 0, 1e-6);
    EXPECT_EQ(normal.z(), 0);
  }
}

TEST(LineNormal, IsZeroAtACorner) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 5; ++k) points.emplace_back(0.1f * k, 0, 0), points.emplace_back(0, 0.1f * k, 0);
  EXPECT_TRUE(line_normal(points.data(), points.size()).isZero());
}

}  // namespace plumb
