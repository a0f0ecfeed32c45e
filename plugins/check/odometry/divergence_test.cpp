#include "divergence.hpp"

#include <gmock/gmock.h>

#include "divergence_testing.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::check_odometry {
namespace {

CheckedOdometry check(const Trajectory& odometry, const Drive& of = drive()) {
  TestContext context;
  return check_odometry(
      odometry, [&](std::size_t k) { return std::make_shared<const Frame>(of.frames[k]); }, {},
      context);
}

double worst_place(const Trajectory& a, const Trajectory& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    worst =
        std::max(worst, (a.T_world_frame[k].translation - b.T_world_frame[k].translation).norm());
  return worst;
}

constexpr std::uint32_t middle = 18;

/// One divergence that begins within 5 frames (which are compared at once) of the first wrong
/// motion, and ends within as many of the last one.
void expect_one(const CheckedOdometry& checked, std::uint32_t first_wrong,
                std::uint32_t last_wrong) {
  ASSERT_EQ(checked.divergences.size(), 1u);
  const Divergence& d = checked.divergences[0];
  EXPECT_LE(d.first, first_wrong + 5);
  EXPECT_GE(d.first + 5, first_wrong);
  EXPECT_GE(d.last + 5, last_wrong);
  EXPECT_LE(d.last, last_wrong + 5);
}

// ---- odometry that is good enough
// -------------------------------------------------------------------------------------------

TEST(CheckOdometry, ContradictsNoneThatIsTrue) {
  ASSERT_GT(drive().frames[0].cloud.size(), 1800u);
  const auto checked = check(drive().truth);
  EXPECT_TRUE(checked.divergences.empty());
  EXPECT_GE(checked.compared, 7u);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1e-9);
}

TEST(CheckOdometry, ContradictsNoneThatDrifts) {
  const auto odometry = changed(drive().truth, [](auto, const Pose& motion) {
    return Pose(motion.rotation * exp_rotation({0, 0, 0.1 * degree}), 1.02 * motion.translation);
  });
  ASSERT_GT(worst_place(odometry, drive().truth), 0.7);
  const auto checked = check(odometry);
  EXPECT_TRUE(checked.divergences.empty());
  EXPECT_LT(worst_place(checked.trajectory, odometry), 1e-9);
}

TEST(CheckOdometry, ContradictsNoneThatIsNoisy) {
  std::mt19937 random(2);
  std::normal_distribution<double> g;
  const auto odometry = changed(drive().truth, [&](auto, const Pose& motion) {
    return motion * Pose(exp_rotation({0, 0, 0.003 * g(random)}),
                         {0.04 * g(random), 0.04 * g(random), 0.02 * g(random)});
  });
  EXPECT_TRUE(check(odometry).divergences.empty());
}

TEST(CheckOdometry, ContradictsNoneThatStopsWhereTheSensorDoes) {
  const Drive stopping = drive_of(0.6, 12, 24);
  ASSERT_LT((stopping.truth.T_world_frame[12].inverse() * stopping.truth.T_world_frame[24])
                .translation.norm(),
            1e-9);
  EXPECT_TRUE(check(stopping.truth, stopping).divergences.empty());
}

// ---- odometry that is not
// ---------------------------------------------------------------------------------------------------

TEST(CheckOdometry, FindsWhereItDoublesItsPath) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k >= middle ? scaled(motion, 2) : motion;
  });
  const auto checked = check(odometry);
  expect_one(checked, middle, 35);
  EXPECT_NEAR(checked.divergences[0].odometry_path / checked.divergences[0].registered_path, 2,
              0.3);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItHalvesItsPath) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k >= middle ? scaled(motion, 0.5) : motion;
  });
  const auto checked = check(odometry);
  expect_one(checked, middle, 35);
  EXPECT_NEAR(checked.divergences[0].odometry_path / checked.divergences[0].registered_path, 0.5,
              0.15);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItStandsStill) {
  const auto odometry = changed(slow_drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k >= middle ? Pose() : motion;
  });
  const auto checked = check(odometry, slow_drive());
  expect_one(checked, middle, 35);
  EXPECT_LT(checked.divergences[0].odometry_path, 0.2 * checked.divergences[0].registered_path);
  EXPECT_LT(worst_place(checked.trajectory, slow_drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItStandsStillForAWhile) {
  const auto odometry = changed(slow_drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k >= middle - 6 && k < middle + 6 ? Pose() : motion;
  });
  const auto checked = check(odometry, slow_drive());
  expect_one(checked, middle - 6, middle + 6);
  EXPECT_LT(worst_place(checked.trajectory, slow_drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItGoesOnWhileTheSensorStands) {
  const Drive stopping = drive_of(0.6, 12, 24);
  const auto odometry = changed(stopping.truth, [](std::uint32_t k, const Pose& motion) {
    return k >= 12 && k < 24 ? Pose(Eigen::Quaterniond::Identity(), {0.6, 0, 0}) : motion;
  });
  const auto checked = check(odometry, stopping);
  expect_one(checked, 12, 24);
  EXPECT_GT(checked.divergences[0].odometry_path, 4 * checked.divergences[0].registered_path);
  EXPECT_LT(worst_place(checked.trajectory, stopping.truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItTurnsBy90Degrees) {
  for (const double angle : {90 * degree, -90 * degree}) {
    const auto odometry = changed(drive().truth, [&](std::uint32_t k, const Pose& motion) {
      return k == middle ? Pose(motion.rotation * exp_rotation({0, 0, angle}), motion.translation)
                         : motion;
    });
    const auto checked = check(odometry);
    expect_one(checked, middle, middle + 1);
    EXPECT_NEAR(checked.divergences[0].rotation_off, 90 * degree, 2 * degree);
    EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
  }
}

TEST(CheckOdometry, FindsWhereItJumps) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k == middle ? Pose(Eigen::Quaterniond::Identity(), {30, 40, 0}) * motion : motion;
  });
  const auto checked = check(odometry);
  expect_one(checked, middle, middle + 1);
  EXPECT_NEAR(checked.divergences[0].translation_off, 50, 0.5);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
}

TEST(CheckOdometry, FindsEachOfTwoDivergences) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k == 8 || k == 27 ? Pose(Eigen::Quaterniond::Identity(), {-30, 40, 0}) * motion : motion;
  });
  const auto checked = check(odometry);
  ASSERT_EQ(checked.divergences.size(), 2u);
  EXPECT_LE(checked.divergences[0].first, 8u);
  EXPECT_GT(checked.divergences[0].last, 8u);
  EXPECT_LE(checked.divergences[1].first, 27u);
  EXPECT_GT(checked.divergences[1].last, 27u);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
}

/// Outside the divergence each motion is the odometry's, to the last bit that products of poses
/// leave.
TEST(CheckOdometry, LeavesAllOtherMotionsAsTheyAre) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k == middle ? Pose(Eigen::Quaterniond::Identity(), {30, 40, 0}) * motion : motion;
  });
  const auto checked = check(odometry);
  ASSERT_EQ(checked.divergences.size(), 1u);
  EXPECT_EQ(checked.trajectory.stamps, odometry.stamps);
  for (std::uint32_t k = 0; k + 1 < odometry.size(); ++k) {
    if (k >= checked.divergences[0].first && k < checked.divergences[0].last) continue;
    const Pose given = odometry.T_world_frame[k].inverse() * odometry.T_world_frame[k + 1],
               kept = checked.trajectory.T_world_frame[k].inverse() *
                      checked.trajectory.T_world_frame[k + 1];
    EXPECT_LT((given.inverse() * kept).translation.norm(), 1e-9) << k;
    EXPECT_LT(angle(given.inverse() * kept), 1e-9) << k;
  }
}

TEST(CheckOdometry, DoesNotDependOnWhereTheWorldIs) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k >= middle ? scaled(motion, 2) : motion;
  });
  Trajectory elsewhere = odometry;
  const Pose far(exp_rotation({0, 0, 2}), {3000, -2000, 50});
  for (auto& pose : elsewhere.T_world_frame) pose = far * pose;
  const auto a = check(odometry), b = check(elsewhere);
  ASSERT_EQ(a.divergences.size(), 1u);
  ASSERT_EQ(b.divergences.size(), 1u);
  EXPECT_EQ(a.divergences[0].first, b.divergences[0].first);
  EXPECT_EQ(a.divergences[0].last, b.divergences[0].last);
}

TEST(Divergence, IsNamedByWhatItLooksLike) {
  Divergence d;
  d.odometry_path = 40, d.registered_path = 20, d.translation_off = 1.5;
  EXPECT_EQ(kind_of(d), "has 2.0 times the path");
  d.odometry_path = 0.2, d.translation_off = 3;
  EXPECT_EQ(kind_of(d), "stands still");
  d = {18, 19, 50, 0.8, 0, 0, 50, 0.01};
  EXPECT_EQ(kind_of(d), "jumps by 50.0 m");
  d = {18, 20, 2, 2, 1.57, 0, 1, 90 * degree};
  EXPECT_EQ(kind_of(d), "turns by 90 deg");
}

// ---- the step
// ---------------------------------------------------------------------------------------------------------------

StepUnderTest checking(const std::vector<Frame>& frames, const Trajectory& odometry) {
  StepUnderTest step(*plumb_module());
  step.each("frames", frames).with("trajectory", odometry);
  return step;
}

TEST(CheckOdometry, NamesFramesAndTimesInANote) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k == middle ? Pose(Eigen::Quaterniond::Identity(), {30, 40, 0}) * motion : motion;
  });
  TestContext context;
  const auto metrics = checking(drive().frames, odometry).run<Metrics>("metrics", context);
  const Divergence d = check(odometry).divergences.at(0);
  EXPECT_EQ(metrics.numbers.front().name, "divergences");
  EXPECT_EQ(metrics.numbers.front().value, 1);
  ASSERT_EQ(metrics.notes.size(), 1u);
  char times[2][32];
  std::snprintf(times[0], sizeof times[0], "frame %u (%.3f s)", d.first, 100 + 0.1 * d.first);
  std::snprintf(times[1], sizeof times[1], "frame %u (%.3f s)", d.last, 100 + 0.1 * d.last);
  EXPECT_THAT(metrics.notes[0], testing::AllOf(testing::HasSubstr("jumps by 50"),
                                               testing::HasSubstr(std::string("from ") + times[0]),
                                               testing::HasSubstr(std::string("to ") + times[1])));
}

TEST(CheckOdometry, PassesATrueTrajectoryOnWithoutANote) {
  TestContext context;
  const auto step = checking(drive().frames, drive().truth);
  EXPECT_TRUE(step.run<Metrics>("metrics", context).notes.empty());
  const auto trajectory = step.run<Trajectory>("trajectory", context);
  EXPECT_EQ(trajectory.stamps, drive().truth.stamps);
  EXPECT_LT(worst_place(trajectory, drive().truth), 1e-9);
}

TEST(CheckOdometry, MultipliesItsLengthsByTheScale) {
  // A model of the street, a tenth as large.
  auto frames = drive().frames;
  for (auto& frame : frames)
    for (auto* axis : {&frame.cloud.x, &frame.cloud.y, &frame.cloud.z})
      for (float& v : *axis) v *= 0.1f;
  auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) {
    return k >= middle ? scaled(motion, 2) : motion;
  });
  for (auto& pose : odometry.T_world_frame) pose.translation *= 0.1;
  TestContext context;
  auto step = checking(frames, odometry);
  step.with("scale", Metrics().add("scale", 0.1, ""));
  EXPECT_EQ(step.run<Metrics>("metrics", context).numbers.front().value, 1);
  const auto trajectory = step.run<Trajectory>("trajectory", context);
  double worst = 0;
  for (std::size_t k = 0; k < frames.size(); ++k)
    worst = std::max(worst, (trajectory.T_world_frame[k].translation -
                             0.1 * drive().truth.T_world_frame[k].translation)
                                .norm());
  EXPECT_LT(worst, 0.1);
}

TEST(CheckOdometry, HasNothingToCompareInOneFrameOrNone) {
  for (const std::size_t n : {0u, 1u}) {
    Trajectory few;
    few.stamps.assign(n, 5);
    few.T_world_frame.resize(n);
    TestContext context;
    const auto metrics =
        checking({drive().frames.begin(), drive().frames.begin() + static_cast<std::ptrdiff_t>(n)},
                 few)
            .run<Metrics>("metrics", context);
    EXPECT_EQ(metrics.numbers[1].value, 0) << n;
  }
}

TEST(CheckOdometry, BelievesTheOdometryWhereScansAreEmpty) {
  std::vector<Frame> empty(drive().frames.size());
  TestContext context;
  EXPECT_EQ(checking(empty, drive().truth).run<Metrics>("metrics", context).numbers.front().value,
            0);
}

TEST(CheckOdometry, RefusesATrajectoryOfOtherFrames) {
  auto frames = drive().frames;
  frames.resize(30);
  TestContext context;
  const auto step = checking(frames, drive().truth);
  EXPECT_EQ(io::refusal([&] { step.run<Metrics>("metrics", context); }),
            "got 30 frames but 36 poses in the trajectory; wire the trajectory of these frames");
}

}  // namespace
}  // namespace plumb::check_odometry
