#include "simulate/drift.hpp"

#include <gmock/gmock.h>

#include "simulate/route.hpp"
#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

using testing::HasSubstr;

Trajectory a_drive(const std::string& name = "blocks", std::size_t frames = 800,
                   double length = 900) {
  return drive({name, frames, length, 10, 1.73, 5});
}

void expect_equal(const Trajectory& a, const Trajectory& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR((a.T_world_frame[k].translation - b.T_world_frame[k].translation).norm(), 0,
                tolerance);
    EXPECT_NEAR(angle(a.T_world_frame[k].inverse() * b.T_world_frame[k]), 0, tolerance);
  }
}

TEST(Route, HasTheLengthAskedAndEvenSteps) {
  for (const std::string& name : route_names())
    for (const double length : {30.0, 200.0, 2900.0}) {
      const auto frames = static_cast<std::size_t>(length) + 1;
      const Trajectory path = a_drive(name, frames, length);
      ASSERT_EQ(path.size(), frames);
      double flat = 0;
      for (std::size_t k = 1; k < path.size(); ++k) {
        const double step =
            (path.T_world_frame[k].translation - path.T_world_frame[k - 1].translation)
                .head<2>()
                .norm();
        EXPECT_LE(step, 1.0001) << name;
        EXPECT_GE(step, 0.95) << name << ' ' << length << ' ' << k;
        EXPECT_GT(path.stamps[k], path.stamps[k - 1]);
        flat += step;
      }
      EXPECT_NEAR(flat, length, 0.01 * length) << name;
    }
}

TEST(Route, LooksAheadAndTurnsNoFasterThanACar) {
  for (const std::string& name : route_names()) {
    const Trajectory path = a_drive(name, 901, 900);
    for (std::size_t k = 1; k < path.size(); ++k) {
      const Pose step = path.T_world_frame[k - 1].inverse() * path.T_world_frame[k];
      EXPECT_GT(step.translation.normalized().x(), 0.95) << name << ' ' << k;
      EXPECT_LT(angle(step), 0.5) << name << ' ' << k;
    }
  }
}

TEST(Route, BlocksReturnsToPlacesBothWays) {
  const Trajectory path = a_drive("blocks", 1451, 2900);  // a pose every 2 m
  int same = 0, opposite = 0;
  for (std::size_t j = 0; j < path.size(); j += 3)
    for (std::size_t i = 0; i + 60 < j; ++i) {
      const Pose between = path.T_world_frame[i].inverse() * path.T_world_frame[j];
      if (between.translation.norm() > 5) continue;
      same += angle(between) < 0.5;
      opposite += angle(between) > 2.6;
    }
  EXPECT_GT(same, 100);
  EXPECT_GT(opposite, 100);
}

TEST(Drift, IsAsLargeAsAskedAndGrowsSlowly) {
  const Trajectory truth = a_drive();
  const Trajectory odometry = drifted(truth, 10, 1);
  EXPECT_NEAR(drift_of(odometry, truth), 10, 1e-3);
  EXPECT_EQ(odometry.stamps, truth.stamps);
  EXPECT_EQ(odometry.T_world_frame[0].translation, truth.T_world_frame[0].translation);
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Pose right = truth.T_world_frame[k - 1].inverse() * truth.T_world_frame[k];
    const Pose made = odometry.T_world_frame[k - 1].inverse() * odometry.T_world_frame[k];
    EXPECT_LT((right.inverse() * made).translation.norm(), 0.1);
  }
  EXPECT_NE(drifted(truth, 10, 2).T_world_frame.back().translation,
            odometry.T_world_frame.back().translation);
}

TEST(Drift, OfZeroIsTheTruth) { expect_equal(drifted(a_drive(), 0, 1), a_drive(), 0); }

TEST(Drift, TransplantedOntoItsOwnPathIsTheOdometryItself) {
  Trajectory truth = a_drive();
  for (std::size_t k = 100; k < 105; ++k)
    truth.T_world_frame[k] = truth.T_world_frame[100];  // a halt
  const Trajectory odometry = drifted(truth, 7, 3);
  expect_equal(transplanted(truth, odometry, truth), odometry, 1e-7);
}

TEST(Drift, TransplantedOntoFewerFramesOfItsPathIsTheSameDrift) {
  const Trajectory truth = a_drive();
  const Trajectory odometry = drifted(truth, 7, 3);
  Trajectory half, expected;
  for (std::size_t k = 0; k < truth.size(); k += 2) {
    half.stamps.push_back(truth.stamps[k]), expected.stamps.push_back(truth.stamps[k]);
    half.T_world_frame.push_back(truth.T_world_frame[k]),
        expected.T_world_frame.push_back(odometry.T_world_frame[k]);
  }
  expect_equal(transplanted(half, odometry, truth), expected, 0.2);
}

TEST(Drift, ALongerPathMeetsTheErrorsAgain) {
  const Trajectory truth = a_drive("out_and_back", 900, 900), source = a_drive("blocks", 200, 200);
  const Trajectory odometry = transplanted(truth, drifted(source, 2, 1), source);
  EXPECT_GT(drift_of(odometry, truth), 2);
}

TEST(Drift, RefusesATransplantOfTwoLengths) {
  const Trajectory a = a_drive(), b = a_drive("blocks", 100, 100);
  EXPECT_THAT(refusal([&] { transplanted(a, a, b); }), HasSubstr("800 poses and its truth 100"));
}

}  // namespace
}  // namespace plumb::simulate
