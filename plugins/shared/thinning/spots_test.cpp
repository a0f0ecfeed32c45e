#include "shared/thinning/spots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace plumb::thinning {
namespace {

struct Points {
  std::vector<Eigen::Vector3f> all;
  void reserve(std::size_t n) { all.reserve(n); }
  void add(const Eigen::Vector3f& p) { all.push_back(p); }
  std::size_t size() const { return all.size(); }
  const Eigen::Vector3f& point(std::size_t k) const { return all[k]; }
};

/// Which points begin a spot, by comparing each with all of them: those that no earlier one lies
/// within `edge` of.
Points beginners(const Points& cloud, float edge) {
  Points result;
  for (const auto& p : cloud.all)
    if (std::ranges::none_of(result.all,
                             [&](const auto& q) { return (q - p).squaredNorm() <= edge * edge; }))
      result.add(p);
  return result;
}

TEST(Spots, ThinAsComparingWithAllOfThemWould) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
  for (const float height : {0.f, 3.f}) {
    Points cloud;
    Spots spots(0.25);
    for (int k = 0; k < 4000; ++k) {
      const float x = 8 * uniform(random), y = 8 * uniform(random);
      const Eigen::Vector3f p(x, y, height * uniform(random));
      cloud.add(p);
      spots.add(p.x(), p.y(), p.z());
    }
    const Points thin = spots.means<Points>(), expected = beginners(cloud, 0.25f);
    ASSERT_EQ(thin.size(), expected.size());
    for (std::size_t k = 0; k < thin.size(); ++k)
      EXPECT_LE((thin.point(k) - expected.point(k)).norm(), 0.25f);
  }
}

TEST(Spots, HoldTheMeanOfTheirPoints) {
  Spots spots(0.5);
  spots.add(1, 1, 0), spots.add(1.4f, 1, 0), spots.add(3, 1, 0), spots.add(0.9f, 1.3f, 0);
  const Points thin = spots.means<Points>();
  ASSERT_EQ(thin.size(), 2u);
  EXPECT_LT((thin.point(0) - Eigen::Vector3f(1.1f, 1.1f, 0)).norm(), 1e-6f);
  EXPECT_LT((thin.point(1) - Eigen::Vector3f(3, 1, 0)).norm(), 1e-6f);
}

TEST(Spots, ThinANoisyWallWithoutTurningIt) {
  // A wall along the robot's way that crosses rows of a grid under a slight angle: the line through
  // the thinned points is the wall.
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.01);
  std::uniform_real_distribution<double> uniform(0, 1);
  double turned = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const double slope = 0.02 * uniform(random) - 0.01, offset = uniform(random);
    Spots spots(0.05);
    for (int k = 0; k < 3000; ++k) {
      const double x = 8 * uniform(random) - 4;
      spots.add(static_cast<float>(x), static_cast<float>(offset + slope * x + noise(random)), 0);
    }
    const Points cloud = spots.means<Points>();
    double xx = 0, xy = 0, x = 0, y = 0;
    for (const auto& p : cloud.all) {
      const double px = p.x(), py = p.y();
      x += px, y += py, xx += px * px, xy += px * py;
    }
    const double n = static_cast<double>(cloud.size());
    turned += std::abs((xy - x * y / n) / (xx - x * x / n) - slope) / 20;
    EXPECT_LT(n, 300);  // 8 m of 0.05 m, and a few beside
  }
  EXPECT_LT(turned, 0.0006);
}

}  // namespace
}  // namespace plumb::thinning
