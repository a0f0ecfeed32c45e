#include "correlative.hpp"

#include <gtest/gtest.h>

#include <random>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/step.hpp"
#include "shared/planar/room_testing.hpp"

namespace plumb::register_correlative {
namespace {

using planar::Walls;

Cloud scan(const Walls& walls, const PlanarPose& at, int beams, double range, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, 0.01);
  Cloud cloud;
  for (int k = 0; k < beams; ++k) {
    const double angle = 2 * M_PI * k / beams,
                 nearest = planar::distance_to(walls, at, at.yaw + angle, range);
    if (nearest >= range) continue;
    const double r = nearest + error(random);
    cloud.add(
        {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)), 0});
  }
  return cloud;
}

const Walls room = {{-3, -2, 5, -2},  {5, -2, 5, 1},   {5, 1, 1.5, 1},
                    {1.5, 1, 1.5, 4}, {1.5, 4, -3, 4}, {-3, 4, -3, -2}};
const Walls corridor = {{-40, -1, 40, -1}, {-40, 1, 40, 1}};

TEST(Correlate, NeedsNoStartWithinItsWindow) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(-0.4, 0.4), turn(-1.1, 1.1);
  for (unsigned round = 0; round < 10; ++round) {
    const PlanarPose motion{step(random), step(random), turn(random)};
    const auto found =
        correlate(scan(room, {}, 360, 20, round), scan(room, motion, 360, 20, 50 + round), {}, {});
    EXPECT_LT(std::hypot(found.T.x - motion.x, found.T.y - motion.y), 0.04) << round;
    EXPECT_NEAR(planar::wrapped(found.T.yaw - motion.yaw), 0, 0.02) << round;
    EXPECT_FALSE(found.retried);
  }
}

TEST(Correlate, LooksAllRoundWhereItsWindowHoldsNothing) {
  const PlanarPose motion{0.9, 0.3, 2.6};
  const auto found = correlate(scan(room, {}, 360, 20, 1), scan(room, motion, 360, 20, 2), {}, {});
  EXPECT_TRUE(found.retried);
  EXPECT_LT(std::hypot(found.T.x - motion.x, found.T.y - motion.y), 0.06);
  EXPECT_NEAR(planar::wrapped(found.T.yaw - motion.yaw), 0, 0.02);
}

TEST(Correlate, AlongABareCorridorTheStartSaysHowFar) {
  const PlanarPose motion{0.2, 0.02, 0.05}, odometry{0.19, 0.0, 0.03};
  const auto found =
      correlate(scan(corridor, {}, 360, 10, 1), scan(corridor, motion, 360, 10, 2), odometry, {});
  EXPECT_NEAR(found.T.x, 0.19, 0.03);
  EXPECT_NEAR(found.T.y, motion.y, 0.02);
  EXPECT_NEAR(found.T.yaw, motion.yaw, 0.01);
}

TEST(Correlate, OverrulesAStartThatIsPlainlyWrong) {
  const PlanarPose motion{0.1, 0, 0.1}, odometry{0.3, -0.2, -0.9};
  const auto found =
      correlate(scan(room, {}, 360, 20, 1), scan(room, motion, 360, 20, 2), odometry, {});
  EXPECT_LT(std::hypot(found.T.x - motion.x, found.T.y - motion.y), 0.04);
}

TEST(Correlate, LeavesThePoseWhereThereIsNothingInRange) {
  Cloud far;
  far.add({100, 0, 0});
  const auto found = correlate(far, scan(room, {}, 90, 20, 1), {1, 2, 0.3}, {});
  EXPECT_EQ(found.score, 0);
  EXPECT_EQ(found.T.x, 1);
}

TEST(CorrelativeStep, AcceptsWhatFitsAndSaysSo) {
  const Segment i = segment_of(scan(room, {}, 360, 20, 1)),
                j = segment_of(scan(room, {0.1, 0.05, 0.1}, 360, 20, 2));
  StepUnderTest step(*plumb_module());
  TestContext context;
  step.over("edges")
      .ends("targets", i, Segment())
      .ends("sources", Segment(), j)
      .part("poses", Pose());
  const auto found = step.run<Registration>("registration", context);
  EXPECT_TRUE(found.accepted);
  EXPECT_GT(found.overlap, 0.7);
  EXPECT_NEAR(found.T_i_j.translation.x(), 0.1, 0.03);
  EXPECT_GT(found.information(0, 0), 0);
  EXPECT_EQ(found.information(2, 2), 0);  // z is not seen
  step.ends("sources", Segment(), segment_of(Cloud()));
  EXPECT_FALSE(step.run<Registration>("registration", context).accepted);
  EXPECT_EQ(context.counts["registrations not accepted"], 1u);
}

}  // namespace
}  // namespace plumb::register_correlative
