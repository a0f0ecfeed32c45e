#include "simulate/indoor_drive.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

const std::vector<Eigen::Vector2d> square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}, {3, 0}};

TEST(IndoorDrive, IsNeitherFasterNorTurnsFasterThanAsked) {
  for (const double speed : {0.2, 1.0})
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const IndoorDrive drive = drive_indoors(square, {speed, 0.1, 10, seed});
      std::size_t at_speed = 0, straight = 0;
      for (std::size_t k = 1; k < drive.size(); ++k) {
        const PlanarPose &a = drive.poses[k - 1], &b = drive.poses[k];
        const double v = 10 * std::hypot(b.x - a.x, b.y - a.y);
        const double w = 10 * std::abs(planar::wrapped(b.yaw - a.yaw));
        EXPECT_LT(v, speed * 1.0001);
        EXPECT_LT(w, 0.1 * 1.0001);
        if (drive.turning[k] && drive.turning[k - 1]) {
          EXPECT_LT(v, 1e-9);
          EXPECT_NEAR(w, 0.1, 1e-9);
        }
        if (drive.turning[k] || drive.turning[k - 1]) continue;
        ++straight;
        at_speed += v > 0.999 * speed;
      }
      EXPECT_GT(static_cast<double>(at_speed), 0.97 * static_cast<double>(straight));
    }
}

TEST(IndoorDrive, LooksWhereItDrives) {
  const IndoorDrive drive = drive_indoors(square, {0.2, 0.1, 5, 3});
  for (std::size_t k = 1; k < drive.size(); ++k) {
    const PlanarPose &a = drive.poses[k - 1], &b = drive.poses[k];
    if (drive.turning[k] || drive.turning[k - 1]) continue;
    EXPECT_NEAR(planar::wrapped(
                    std::atan2(b.y - a.y, b.x - a.x) -
                    0.5 * (a.yaw + b.yaw + (std::abs(a.yaw - b.yaw) > 3 ? 6.283185307179586 : 0))),
                0, 2e-3);
  }
}

TEST(IndoorDrive, BeginsAtTheOriginAndHoldsItsRate) {
  const IndoorDrive drive = drive_indoors(square, {0.2, 0.1, 5, 3});
  EXPECT_EQ(drive.poses.front().x, 0);
  EXPECT_EQ(drive.poses.front().y, 0);
  EXPECT_NEAR(drive.poses.front().yaw, 0, 1e-12);
  for (std::size_t k = 0; k < drive.size(); ++k)
    EXPECT_DOUBLE_EQ(drive.stamps[k], 0.2 * static_cast<double>(k));
  // 43 m and four quarter turns
  EXPECT_NEAR(drive.stamps.back(), 43 / 0.2 + 4 * 15.708, 1.5);
  EXPECT_NEAR(drive.poses.back().x, 3, 0.05);
}

TEST(WheelOdometry, ErrsByTheDriftThatIsAsked) {
  const std::vector<PlanarPose> truth = drive_indoors(square, {0.2, 0.1, 5, 3}).poses;
  for (const double drift : {0.3, 4.0}) {
    const std::vector<PlanarPose> made = wheel_odometry(truth, drift, 9);
    double greatest = 0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      greatest = std::max(greatest, std::hypot(made[k].x - truth[k].x, made[k].y - truth[k].y));
    EXPECT_NEAR(greatest, drift, 1e-6);
    EXPECT_EQ(made[0].x, truth[0].x);
    EXPECT_EQ(made[0].yaw, truth[0].yaw);
    const double way = way_length(made) / way_length(truth);
    EXPECT_NEAR(way, 1, 0.15);
  }
  EXPECT_EQ(wheel_odometry(truth, 0, 9)[100].x, truth[100].x);
  EXPECT_NE(wheel_odometry(truth, 1, 9)[100].x, wheel_odometry(truth, 1, 10)[100].x);
}

TEST(LostScans, FallIntoTurnsOnly) {
  const IndoorDrive drive = drive_indoors(square, {0.2, 0.1, 20, 3});
  const std::vector<char> lost = lost_scans(drive, {0.4, 0, 0, 1});
  double turning = 0, gone = 0;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    EXPECT_TRUE(!lost[k] || drive.turning[k]);
    turning += drive.turning[k], gone += lost[k];
  }
  EXPECT_GT(turning, 1000);
  EXPECT_NEAR(gone / turning, 0.4, 0.05);
  EXPECT_EQ(std::count(lost.begin(), lost.end(), 1), static_cast<std::ptrdiff_t>(gone));
  const std::vector<char> none = lost_scans(drive, {});
  EXPECT_EQ(std::count(none.begin(), none.end(), 1), 0);
}

TEST(LostScans, AreWholeStretchesApartFromEachOther) {
  const IndoorDrive drive = drive_indoors(square, {0.2, 0.1, 5, 3});
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const std::vector<char> lost = lost_scans(drive, {0, 4, 12, seed});
    std::vector<std::size_t> stretches;
    for (std::size_t k = 1; k < lost.size(); ++k) {
      if (lost[k] && !lost[k - 1]) stretches.push_back(0);
      if (lost[k]) ++stretches.back();
    }
    EXPECT_EQ(stretches.size(), 4u);
    for (const std::size_t scans : stretches) EXPECT_NEAR(static_cast<double>(scans), 60, 1);
  }
  EXPECT_THAT(refusal([&] {
                lost_scans(drive, {0, 40, 12, 1});
              }),
              testing::HasSubstr("ask for fewer or shorter ones"));
}

}  // namespace
}  // namespace plumb::simulate
