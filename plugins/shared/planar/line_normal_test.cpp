#include "shared/planar/line_normal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumb::planar {
namespace {

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
  for (int k = 0; k < 5; ++k)
    points.emplace_back(0.1f * k, 0, 0), points.emplace_back(0, 0.1f * k, 0);
  EXPECT_TRUE(line_normal(points.data(), points.size()).isZero());
}

}  // namespace
}  // namespace plumb::planar
