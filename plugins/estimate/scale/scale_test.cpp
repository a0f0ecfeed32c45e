#include "scale.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::estimate_scale {
namespace {

/// Frames every `period` [s] along x, one motion a speed [m/s].
Trajectory with_speeds(const std::vector<double>& speeds, double period = 0.1) {
  Trajectory trajectory;
  trajectory.stamps = {1000};
  trajectory.T_world_frame = {Pose()};
  for (const double speed : speeds) {
    const Eigen::Vector3d last = trajectory.T_world_frame.back().translation;
    trajectory.stamps.push_back(trajectory.stamps.back() + period);
    trajectory.T_world_frame.push_back(
        {Eigen::Quaterniond::Identity(), last + Eigen::Vector3d(speed * period, 0, 0)});
  }
  return trajectory;
}
/// Walking pace with changes: 0.7 to 1.5 m/s.
std::vector<double> a_walk() {
  Random random(3);
  std::vector<double> speeds;
  for (int k = 0; k < 301; ++k) speeds.push_back(0.7 + 0.8 * random.uniform());
  return speeds;
}
Metrics run(const Trajectory& trajectory, const ParameterValues& values = {}) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("trajectory", trajectory);
  for (const auto& [name, value] : values) step.set(name, value);
  return step.run<Metrics>("scale", context);
}

TEST(UsualSpeed, IsThatOfASteadyMotionAtAnyRateOfFrames) {
  EXPECT_NEAR(usual_speed(with_speeds(std::vector<double>(50, 8.0))), 8, 1e-9);
  EXPECT_NEAR(usual_speed(with_speeds(std::vector<double>(50, 8.0), 2.5)), 8, 1e-9);
}

TEST(UsualSpeed, IsTheMedianOfSpeedsAndNotMovedByAJump) {
  auto speeds = a_walk();
  auto sorted = speeds;
  std::ranges::sort(sorted);
  EXPECT_NEAR(usual_speed(with_speeds(speeds)), sorted[150], 1e-9);
  speeds[20] = 500;
  EXPECT_NEAR(usual_speed(with_speeds(speeds)), sorted[150], 0.01);
}

TEST(UsualSpeed, LeavesRestsOutThatAreNotQuiteStill) {
  auto speeds = a_walk();
  const double walking = usual_speed(with_speeds(speeds));
  for (int k = 0; k < 1000; ++k)
    speeds.push_back(0.001 * (k % 50));  // up to 5 cm/s of noise, three quarters of the time
  EXPECT_NEAR(usual_speed(with_speeds(speeds)), walking, 1e-9);
}

TEST(UsualSpeed, TurnsWithTheWorldAndGrowsWithIt) {
  const Trajectory walk = with_speeds(a_walk());
  const Pose elsewhere(exp_rotation({0.3, -1, 2}), {4e5, 5e6, 100});
  Trajectory moved = walk, large = walk;
  for (auto& pose : moved.T_world_frame) pose = elsewhere * pose;
  for (auto& pose : large.T_world_frame) pose.translation *= 3;
  EXPECT_NEAR(usual_speed(moved), usual_speed(walk), 1e-6);
  EXPECT_NEAR(usual_speed(large), 3 * usual_speed(walk), 1e-9);
}

TEST(UsualSpeed, IsZeroWhereNothingTellsIt) {
  EXPECT_EQ(usual_speed({}), 0);
  EXPECT_EQ(usual_speed(with_speeds({})), 0);
  EXPECT_EQ(usual_speed(with_speeds(std::vector<double>(50, 0.0))), 0);
  EXPECT_EQ(usual_speed(with_speeds(std::vector<double>(50, 8.0), 0)),
            0);  // the stamps stand still
}

TEST(UsualSpeed, PassesOverStampsThatStepBack) {
  Trajectory trajectory = with_speeds(std::vector<double>(50, 8.0));
  trajectory.stamps[20] -= 60;
  EXPECT_NEAR(usual_speed(trajectory), 8, 1e-6);
}

TEST(ScaleAt, GrowsWithTheSpeedFromTheLeastToOne) {
  EXPECT_EQ(scale_at(2, 4, 0.25), 0.5);
  EXPECT_EQ(scale_at(0.5, 4, 0.25), 0.25);
  EXPECT_EQ(scale_at(4, 4, 0.25), 1);
  EXPECT_EQ(scale_at(30, 4, 0.25), 1);
  EXPECT_EQ(scale_at(0, 4, 0.25), 1) << "no speed, nothing known";
}

TEST(EstimateScale, TellsACarFromAWalk) {
  EXPECT_EQ(run(with_speeds(std::vector<double>(50, 8.0))).numbers[0].value, 1);
  const double walk = run(with_speeds(a_walk())).numbers[0].value;
  EXPECT_NEAR(walk, 1.1 / 4, 0.02);
  EXPECT_NEAR(run(with_speeds(a_walk()), {{"full_speed", 2.0}}).numbers[0].value, 2 * walk, 1e-9);
  EXPECT_EQ(run(with_speeds(a_walk()), {{"min_factor", 0.5}}).numbers[0].value, 0.5);
}

TEST(EstimateScale, GivesTheFactorFirstAndTheSpeedWithItsUnit) {
  const Metrics scale = run(with_speeds(std::vector<double>(50, 2.0)));
  ASSERT_EQ(scale.numbers.size(), 2u);
  EXPECT_EQ(scale.numbers[0].name, "scale");
  EXPECT_EQ(scale.numbers[0].unit, "");
  EXPECT_NEAR(scale.numbers[0].value, 0.5, 1e-9);
  EXPECT_EQ(scale.numbers[1].name, "speed");
  EXPECT_EQ(scale.numbers[1].unit, "m/s");
  EXPECT_NEAR(scale.numbers[1].value, 2, 1e-9);
}

TEST(EstimateScale, TakesAFactorThatIsKnownWhateverTheSpeed) {
  const Metrics scale = run(with_speeds(std::vector<double>(50, 8.0)), {{"factor", 2.5}});
  EXPECT_EQ(scale.numbers[0].value, 2.5);
  EXPECT_NEAR(scale.numbers[1].value, 8, 1e-9);
}

TEST(EstimateScale, IsOneForATrajectoryWithoutMotion) {
  EXPECT_EQ(run({}).numbers[0].value, 1);
  EXPECT_EQ(run(with_speeds(std::vector<double>(50, 0.0))).numbers[0].value, 1);
}

}  // namespace
}  // namespace plumb::estimate_scale
