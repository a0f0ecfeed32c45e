#include "plumb/slam/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb {
namespace {

/// A straight drive along x, one pose a metre and second.
Trajectory straight(std::size_t count) {
  Trajectory result;
  for (std::size_t k = 0; k < count; ++k) {
    result.stamps.push_back(static_cast<double>(k));
    result.T_world_frame.emplace_back(Eigen::Quaterniond::Identity(),
                                      Eigen::Vector3d(static_cast<double>(k), 0, 0));
  }
  return result;
}

TEST(TrajectoryError, IsZeroForTheTruthInAnotherFrame) {
  const Trajectory truth = straight(30);
  Trajectory moved = truth;
  const Pose T(exp_rotation({1, -2, 0.5}), Eigen::Vector3d(100, 200, -300));
  for (auto& pose : moved.T_world_frame) pose = T * pose;
  const auto pairs = pair_by_stamp(moved, truth);
  ASSERT_EQ(pairs.size(), 30u);
  EXPECT_LT(absolute_error(pairs).max, 1e-10);
  EXPECT_LT(relative_error(pairs).translation, 1e-10);
  EXPECT_LT(relative_error(pairs).rotation, 1e-7);
}

TEST(TrajectoryError, OfAStretchedPathIsTheOneReckonedByHand) {
  // 1 % too long: after alignment at the middle the errors are 0.01 * (-2, -1, 0, 1, 2) * 5.
  Trajectory truth, estimate;
  for (int k = -2; k <= 2; ++k) {
    truth.stamps.push_back(k);
    estimate.stamps.push_back(k + 1e-3);
    truth.T_world_frame.emplace_back(Eigen::Quaterniond::Identity(), Eigen::Vector3d(5 * k, 0, 0));
    estimate.T_world_frame.emplace_back(Eigen::Quaterniond::Identity(),
                                        Eigen::Vector3d(5.05 * k, 0, 0));
  }
  const auto pairs = pair_by_stamp(estimate, truth);
  ASSERT_EQ(pairs.size(), 5u);
  EXPECT_NEAR(absolute_error(pairs).max, 0.1, 1e-12);
  EXPECT_NEAR(absolute_error(pairs).rmse, 0.05 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(relative_error(pairs).translation, 0.1, 1e-12);  // two poses, 10 m, further on
  EXPECT_NEAR(relative_error(pairs).rotation, 0, 1e-12);
}

TEST(TrajectoryError, OfASteadyTurnIsItsAngleOverTheLength) {
  const Trajectory truth = straight(41);
  Trajectory turning = truth;
  for (std::size_t k = 0; k < 41; ++k)
    turning.T_world_frame[k].rotation = exp_rotation({0.002 * static_cast<double>(k), 0, 0});
  EXPECT_NEAR(relative_error(pair_by_stamp(turning, truth)).rotation, 0.02, 1e-9);
  EXPECT_NEAR(absolute_error(pair_by_stamp(turning, truth)).max, 0, 1e-9);
}

TEST(TrajectoryError, IsMadeOfTheErrorsOfItsPairs) {
  Trajectory estimate = straight(30);
  for (std::size_t k = 0; k < 30; ++k)
    estimate.T_world_frame[k].translation.y() = 0.01 * static_cast<double>(k * k % 7);
  const auto pairs = pair_by_stamp(estimate, straight(30));
  double squares = 0, translation = 0;
  for (const double squared : squared_errors(pairs)) squares += squared;
  EXPECT_DOUBLE_EQ(std::sqrt(squares / 30), absolute_error(pairs).rmse);
  const auto relative = relative_errors(pairs);
  ASSERT_EQ(relative.size(), 20u);  // of 30 m the last 10 have no pose 10 m on
  for (const RelativeError& error : relative) translation += error.translation;
  EXPECT_DOUBLE_EQ(translation / 20, relative_error(pairs).translation);
}

TEST(TrajectoryError, PairsOnlyStampsWithinTheTolerance) {
  const Trajectory truth = straight(10);
  Trajectory some;
  some.stamps = {-5, 0.0019, 1.0021, 2.9985, 4.5, 9.001, 20};
  some.T_world_frame.resize(some.stamps.size());
  const auto pairs = pair_by_stamp(some, truth);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs.truth[0].translation.x(), 0);
  EXPECT_EQ(pairs.truth[1].translation.x(), 3);
  EXPECT_EQ(pairs.truth[2].translation.x(), 9);
}

TEST(TrajectoryError, PairsStampsThatStepBack) {
  Trajectory truth = straight(10), estimate = straight(10);
  std::swap(truth.stamps[3], truth.stamps[4]),
      std::swap(truth.T_world_frame[3], truth.T_world_frame[4]);
  std::swap(estimate.stamps[6], estimate.stamps[7]),
      std::swap(estimate.T_world_frame[6], estimate.T_world_frame[7]);
  const auto pairs = pair_by_stamp(estimate, truth);
  ASSERT_EQ(pairs.size(), 10u);
  EXPECT_EQ(absolute_error(pairs).max, 0);
  EXPECT_EQ(pairs.truth[6].translation.x(), 7);
}

TEST(TrajectoryError, OfNothingOrOfAShortPathIsNoNumber) {
  EXPECT_TRUE(std::isnan(absolute_error({}).rmse));
  EXPECT_EQ(pair_by_stamp(straight(3), {}).size(), 0u);
  const auto pairs = pair_by_stamp(straight(5), straight(5));
  EXPECT_TRUE(std::isnan(relative_error(pairs).translation));
  EXPECT_EQ(absolute_error(pairs).rmse, 0);
}

}  // namespace
}  // namespace plumb
