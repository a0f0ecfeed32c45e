#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "motion_noise.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::constrain_odometry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Eigen::Vector3d gauss3(std::mt19937& random, const Eigen::Vector3d& sigma) {
  std::normal_distribution<double> g(0, 1);
  const double x = g(random), y = g(random), z = g(random);
  return sigma.cwiseProduct(Eigen::Vector3d(x, y, z));
}
/// The poses that these motions lead to, one after another.
Poses chain(const std::vector<Pose>& motions) {
  Poses poses{{Pose(exp_rotation({0.1, 0.2, 1}), {300, -200, 10})}};
  for (const Pose& motion : motions)
    poses.T_world_segment.push_back(poses.T_world_segment.back() * motion);
  return poses;
}
/// A drive of n motions of 8 to 12 m with turns of up to 0.3 rad.
std::vector<Pose> drive(std::size_t n, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<Pose> motions;
  for (std::size_t k = 0; k < n; ++k) {
    const double length = 8 + 4 * random.uniform(), turn = 0.6 * random.uniform() - 0.3;
    motions.push_back({exp_rotation({0, 0, turn}), {length, 0, 0}});
  }
  return motions;
}
/// The drive with errors in each motion, in the axes of its end, of `factor` times the deviations
/// expected.
std::vector<Pose> with_errors(const std::vector<Pose>& motions, const Vector6d& factor,
                              std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto expected = odometry_noise(chain(motions), nullptr, {}, 10, 6).motions;
  std::vector<Pose> result;
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const Vector6d sigma = factor.cwiseProduct(expected[k].sigma);
    const Eigen::Vector3d t = gauss3(random, sigma.head<3>()), w = gauss3(random, sigma.tail<3>());
    result.push_back(motions[k] * Pose(exp_rotation(w), t));
  }
  return result;
}
const MotionNoise usual;

TEST(OdometryNoise, GrowsWithThePathAndTheTurnFromWhatItIsAtRest) {
  const Pose rest, straight(Eigen::Quaterniond::Identity(), {0, 10, 0}),
      turn(exp_rotation({0, 0, 1.5}), {0, 0, 0});
  const auto noise = odometry_noise(chain({rest, straight, turn}), nullptr, usual, 10, 6);
  ASSERT_EQ(noise.motions.size(), 3u);
  EXPECT_NEAR(noise.motions[0].sigma[0], 0.02, 1e-9);
  EXPECT_NEAR(noise.motions[0].sigma[5], 0.05 * deg, 1e-9);
  EXPECT_NEAR(noise.motions[1].sigma[2], std::hypot(0.02, 0.3), 1e-9);
  EXPECT_NEAR(noise.motions[1].sigma[3], std::hypot(0.05 * deg, 1 * deg), 1e-9);
  EXPECT_NEAR(noise.motions[2].sigma[0], 0.02, 1e-9);
  EXPECT_NEAR(noise.motions[2].sigma[4], std::hypot(0.05 * deg, 0.03), 1e-9);
  EXPECT_EQ(noise.factor, Vector6d::Ones());
  EXPECT_THAT(noise.outliers, IsEmpty());
}

TEST(OdometryNoise, FindsHowGoodTheOdometryIsAxisByAxis) {
  Vector6d planted;
  planted << 2, 0.5, 1, 0.5, 1, 2;
  const auto truth = drive(2000);
  const Poses odometry = chain(with_errors(truth, planted, 7)), registered = chain(truth);
  const auto noise = odometry_noise(odometry, &registered, usual, 10, 6);
  for (int axis = 0; axis < 6; ++axis)
    EXPECT_NEAR(noise.factor[axis] / planted[axis], 1, 0.1) << axis;
  const auto expected = odometry_noise(odometry, nullptr, usual, 10, 6).motions;
  EXPECT_LT((noise.motions[5].sigma - noise.factor.cwiseProduct(expected[5].sigma)).norm(), 1e-12);
}

TEST(OdometryNoise, SeesAWrongScaleAlongTheMotionWhateverTheHeading) {
  std::vector<Pose> motions, longer;
  for (int k = 0; k < 60; ++k) {
    motions.push_back({exp_rotation({0, 0, 0.1}), {10, 0, 0}});
    longer.push_back({exp_rotation({0, 0, 0.1}), {10.5, 0, 0}});
  }
  const Poses registered = chain(motions);
  const auto sigma = odometry_noise(chain(longer), &registered, usual, 10, 6).motions[30].sigma;
  EXPECT_GT(sigma[0], 0.4);
  EXPECT_LT(sigma[1], 0.3)
      << "0.5 m forward stand by a tenth of it to the side, in the turned axes of the motion's end";
  EXPECT_LT(sigma[2], 0.1);
}

TEST(OdometryNoise, IsScaledByNoMoreThanTheMostEitherWay) {
  const auto truth = drive(100);
  const Poses registered = chain(truth);
  EXPECT_LT((odometry_noise(registered, &registered, usual, 4, 6).factor - Vector6d::Constant(0.25))
                .norm(),
            1e-12);
  const Poses bad = chain(with_errors(truth, Vector6d::Constant(50), 2));
  EXPECT_LT((odometry_noise(bad, &registered, usual, 4, 6).factor - Vector6d::Constant(4)).norm(),
            1e-12);
}

TEST(OdometryNoise, HoldsAMotionThatContradictsTheRegistrationsNoFirmerThanTheDifference) {
  const auto truth = drive(50);
  auto motions = with_errors(truth, Vector6d::Ones(), 3);
  const Poses registered = chain(truth);
  const auto clean = odometry_noise(chain(motions), &registered, usual, 10, 6);
  EXPECT_THAT(clean.outliers, IsEmpty());
  motions[20].translation.y() += 30;
  const auto noise = odometry_noise(chain(motions), &registered, usual, 10, 6);
  EXPECT_THAT(noise.outliers, ElementsAre(20u));
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(noise.motions[20].sigma[axis], 30, 5);
  for (const std::size_t other : {19u, 21u})
    EXPECT_LT((noise.motions[other].sigma.array() / clean.motions[other].sigma.array()).maxCoeff(),
              1.2);
}

TEST(OdometryNoise, OfFewerThanTwoPosesIsNone) {
  const Poses one{{Pose()}};
  EXPECT_THAT(odometry_noise(one, &one, usual, 10, 6).motions, IsEmpty());
  EXPECT_THAT(odometry_noise({}, nullptr, usual, 10, 6).motions, IsEmpty());
}

TEST(OdometryConstraints, CountOneForOneStandardDeviationAlongEachAxis) {
  const Poses odometry = chain(drive(4));
  const auto noise = odometry_noise(odometry, nullptr, usual, 10, 6);
  const Constraints constraints = constraints_from(noise.motions);
  ASSERT_EQ(constraints.relative.size(), 4u);
  EXPECT_FALSE(constraints.planar);
  const RelativePose& r = constraints.relative[2];
  EXPECT_EQ(r.i, 2u);
  EXPECT_EQ(r.j, 3u);
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6d off = noise.motions[2].sigma[axis] * Vector6d::Unit(axis);
    const Pose moved =
        odometry.T_world_segment[3] * Pose(exp_rotation(off.tail<3>()), off.head<3>());
    const Pose d = r.T_i_j.inverse() * odometry.T_world_segment[2].inverse() * moved;
    Vector6d e;  // g2o's error
    e << d.translation, d.rotation.vec();
    EXPECT_NEAR(e.dot(r.information * e), 1, 1e-3) << axis;
  }
}

// ---- the step
// ---------------------------------------------------------------------------------------------------------------------

/// Four segments of three frames, 1 m apart along x, cut from another trajectory: only first and
/// end count.
std::vector<FrameRange> ranges() {
  std::vector<FrameRange> result(4);
  for (std::uint32_t k = 0; k < 4; ++k) result[k].first = 3 * k, result[k].end = 3 * k + 3;
  return result;
}
Trajectory odometry() {
  Trajectory trajectory;
  for (int k = 0; k < 12; ++k) {
    trajectory.stamps.push_back(0.1 * k);
    trajectory.T_world_frame.push_back(
        {Eigen::Quaterniond::Identity(), {static_cast<double>(k), 0, 0}});
  }
  return trajectory;
}
Poses middles() {
  Poses poses;
  for (const FrameRange& range : ranges())
    poses.T_world_segment.push_back(odometry().T_world_frame[range.first + 1]);
  return poses;
}
StepUnderTest wired() {
  StepUnderTest step(*plumb_module());
  step.with("trajectory", odometry()).each("ranges", ranges());
  return step;
}
/// Median deviation of x and of yaw that the step used.
std::pair<double, double> sigmas(StepUnderTest step) {
  TestContext context;
  const auto numbers = step.run<Metrics>("metrics", context).numbers;
  return {numbers[0].value, numbers[5].value};
}

TEST(ConstrainOdometry, JoinsTheMiddleFramesOfEachSegmentAndTheNext) {
  TestContext context;
  const auto constraints = wired().run<Constraints>("constraints", context);
  ASSERT_EQ(constraints.relative.size(), 3u);
  for (std::uint32_t k = 0; k < 3; ++k) {
    EXPECT_EQ(constraints.relative[k].i, k);
    EXPECT_EQ(constraints.relative[k].j, k + 1);
    EXPECT_LT((constraints.relative[k].T_i_j.translation - Eigen::Vector3d(3, 0, 0)).norm(), 1e-12);
  }
  EXPECT_NEAR(constraints.relative[0].information(0, 0), 1 / (0.02 * 0.02 + 0.09 * 0.09), 1e-6);
  const auto metrics = wired().run<Metrics>("metrics", context);
  std::vector<std::string> names;
  for (const auto& number : metrics.numbers) names.push_back(number.name + "[" + number.unit + "]");
  EXPECT_THAT(names, ElementsAre("sigma_x[m]", "sigma_y[m]", "sigma_z[m]", "sigma_roll[rad]",
                                 "sigma_pitch[rad]", "sigma_yaw[rad]", "outliers[]"));
}

TEST(ConstrainOdometry, TakesTheParametersOfTheNoise) {
  auto step = wired();
  step.set("translation_per_metre", 0.1)
      .set("min_translation_sigma", 1e-6)
      .set("rotation_per_metre", 2e-8)
      .set("min_rotation_sigma", 0.2);
  const auto [x, yaw] = sigmas(step);
  EXPECT_NEAR(x, 0.3, 1e-9);
  EXPECT_NEAR(yaw, 0.2, 1e-9);
}

TEST(ConstrainOdometry, CountsMotionsThatContradictTheRegistrations) {
  Poses registered = middles();
  registered.T_world_segment[3].translation.y() += 5;
  TestContext context;
  const auto metrics = wired().with("registered", registered).run<Metrics>("metrics", context);
  EXPECT_EQ(metrics.numbers[6].value, 1);
  EXPECT_EQ(context.counts["motions of the odometry contradicted by the registrations"], 1u);
  EXPECT_NEAR(sigmas(wired().with("registered", middles())).first, std::hypot(0.02, 0.09) / 10,
              1e-9);
}

TEST(ConstrainOdometry, RefusesPosesAndRangesOfOtherSegments) {
  TestContext context;
  Poses registered = middles();
  registered.T_world_segment.pop_back();
  const auto other_poses = io::refusal(
      [&] { wired().with("registered", registered).run<Constraints>("constraints", context); });
  EXPECT_THAT(other_poses, HasSubstr("4 segments and 3 registered poses"));
  auto far = ranges();
  far[3].end = 13;
  const auto other_frames =
      io::refusal([&] { wired().each("ranges", far).run<Constraints>("constraints", context); });
  EXPECT_THAT(other_frames, HasSubstr("segment 3 has frames up to 13, the trajectory only 12"));
}

TEST(ConstrainOdometry, WithAScaleMultipliesLengthsAndDividesAnglesByLength) {
  const auto step = [](double per_metre, double translation, double scale) {
    auto s = wired();
    s.set("rotation_per_metre", per_metre).set("min_translation_sigma", translation);
    if (scale != 1) s.with("scale", Metrics().add("scale", scale, "").add("speed", 3, "m/s"));
    return sigmas(s);
  };
  EXPECT_EQ(step(0.01, 0.4, 0.25), step(0.04, 0.1, 1));
  EXPECT_EQ(step(0.01, 0.4, 2), step(0.005, 0.8, 1));
  EXPECT_NE(step(0.01, 0.4, 1).first, step(0.01, 0.1, 1).first);
  EXPECT_NE(step(0.01, 0.4, 1).second, step(0.04, 0.4, 1).second);
}

TEST(ConstrainOdometry, WithAScaleLeavesRatiosAndAnglesAlone) {
  const auto step = [](double scale) {  // lengths and angles by length without weight
    auto s = wired();
    s.set("rotation_per_metre", 2e-8)
        .set("min_translation_sigma", 1e-6)
        .set("translation_per_metre", 0.5)
        .set("min_rotation_sigma", 0.1);
    return sigmas(s.with("scale", Metrics().add("scale", scale, "")));
  };
  EXPECT_NEAR(step(0.25).first, 1.5, 1e-9);
  EXPECT_NEAR(step(0.25).second, 0.1, 1e-9);
}

TEST(ConstrainOdometry, RefusesAScaleWithoutAPositiveNumber) {
  TestContext context;
  const auto said = [&](const Metrics& scale) {
    return io::refusal(
        [&] { wired().with("scale", scale).run<Constraints>("constraints", context); });
  };
  EXPECT_THAT(said({}), HasSubstr("'scale' must have a positive number"));
  for (const double value : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(said(Metrics().add("scale", value, "")),
                HasSubstr("'scale' must have a positive number"))
        << value;
  EXPECT_EQ(said(Metrics().add("scale", 0.3, "")), "(nothing was refused)");
}

}  // namespace
}  // namespace plumb::constrain_odometry
