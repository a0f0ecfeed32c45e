#include "simulate/laser_2d.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using std::numbers::pi;

/// A room 8 m by 6 m about the origin.
std::vector<Wall> box_room() {
  FloorPlan plan;
  plan.open({-4, -3, 4, 3});
  return plan.walls();
}

TEST(Laser2d, ReadsTheKnownDistancesInABoxRoom) {
  const Laser2d laser({1.5 * pi, 541, 10, 0}, 1);
  const PlanarPose pose{1.3, -0.7, 0.4};
  const std::vector<double> ranges = laser.exact(box_room(), pose);
  ASSERT_EQ(ranges.size(), 541u);
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const double angle = pose.yaw - 0.75 * pi + static_cast<double>(k) * 1.5 * pi / 540;
    const double to_x = (std::cos(angle) > 0 ? 4 - pose.x : -4 - pose.x) / std::cos(angle);
    const double to_y = (std::sin(angle) > 0 ? 3 - pose.y : -3 - pose.y) / std::sin(angle);
    EXPECT_NEAR(ranges[k], std::min(to_x, to_y), 1e-9) << "beam " << k;
  }
}

TEST(Laser2d, ReadsItsGreatestRangeWhereNothingIsNearer) {
  const Laser2d laser({1.5 * pi, 271, 3.5, 0.05}, 1);
  const std::vector<double> ranges = laser.scan(box_room(), {}, 0);
  EXPECT_EQ(ranges[135], 3.5);       // ahead is 4 m away
  EXPECT_LT(ranges[135 + 90], 3.3);  // to the left are 3 m
  EXPECT_LE(*std::max_element(ranges.begin(), ranges.end()), 3.5);
}

TEST(Laser2d, AgreesWithMeetingEveryBeamWithEveryWall) {
  Random random(5);
  for (int round = 0; round < 60; ++round) {
    std::vector<Wall> walls;
    for (int k = 0; k < 40; ++k) {
      const Eigen::Vector2d a(random.uniform(-9, 9), random.uniform(-9, 9));
      walls.push_back({a, a + Eigen::Vector2d(random.uniform(-6, 6), random.uniform(-6, 6))});
    }
    const PlanarPose pose{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-4, 4)};
    const double view = round % 3 == 0 ? 2 * pi : random.uniform(0.3, 2 * pi);
    const Laser2d laser({view, 97, 8, 0}, 1);
    const std::vector<double> ranges = laser.exact(walls, pose);
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      const double angle = pose.yaw + laser.first_angle() + laser.step() * static_cast<double>(k);
      double nearest = 8;
      for (const Wall& wall : walls)
        nearest = std::min(nearest,
                           distance_to(wall, {pose.x, pose.y}, {std::cos(angle), std::sin(angle)}));
      EXPECT_EQ(ranges[k], nearest) << "round " << round << " beam " << k;
    }
  }
}

TEST(Laser2d, OverAFullCircleNoDirectionIsMeasuredTwice) {
  const Laser2d laser({2 * pi, 360, 10, 0}, 1);
  EXPECT_NEAR(laser.step(), pi / 180, 1e-12);
  EXPECT_NEAR(Laser2d({pi, 181, 10, 0}, 1).step(), pi / 180, 1e-12);
  EXPECT_NEAR(Laser2d({pi, 181, 10, 0}, 1).first_angle(), -pi / 2, 1e-12);
}

TEST(Laser2d, NoiseHasItsDeviationAndBelongsToTheScan) {
  const Laser2d laser({1.5 * pi, 541, 10, 0.01}, 7);
  const std::vector<Wall> room = box_room();
  const std::vector<double> exact = laser.exact(room, {});
  double sum = 0, squares = 0;
  constexpr std::uint64_t scans = 40;
  for (std::uint64_t n = 0; n < scans; ++n) {
    const std::vector<double> noisy = laser.scan(room, {}, n);
    for (std::size_t k = 0; k < noisy.size(); ++k)
      sum += noisy[k] - exact[k], squares += std::pow(noisy[k] - exact[k], 2);
  }
  const double count = 541.0 * scans;
  EXPECT_NEAR(sum / count, 0, 3e-4);
  EXPECT_NEAR(std::sqrt(squares / count), 0.01, 3e-4);
  EXPECT_EQ(laser.scan(room, {}, 3), laser.scan(room, {}, 3));
  EXPECT_NE(laser.scan(room, {}, 3), laser.scan(room, {}, 4));
}

}  // namespace
}  // namespace plumb::simulate
