#include "divergence.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "plumb/data/values.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "scan_pair.hpp"

namespace plumb {
namespace {

constexpr double degree = M_PI / 180;

// ---- a street, as a scanner sees it that is driven through it ---------------------------------------------------------------

struct Block {
  Eigen::Vector3d low, high;  ///< [m]
};

/// Houses with gaps on both sides, parked cars and poles, along x from -40 m to 160 m.
std::vector<Block> street(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Block> blocks;
  for (const double side : {-1.0, 1.0}) {
    for (double x = -40; x < 160;) {
      const double length = 4 + 6 * u(random), from = 5 + 3 * u(random), to = from + 10, height = 5 + 6 * u(random);
      blocks.push_back({{x, std::min(side * from, side * to), -2}, {x + length, std::max(side * from, side * to), height}});
      x += length + 1 + 2 * u(random);
    }
    for (double x = -40; x < 160; x += 6 + 4 * u(random)) {
      const double y = side * (3.5 + u(random));
      blocks.push_back({{x, y, -2}, {x + 0.3, y + 0.3, 6}});
    }
    for (double x = -38; x < 160; x += 8 + 6 * u(random)) {
      const double y = side * 2.8 - 0.9;
      blocks.push_back({{x, y, -2}, {x + 4.5, y + 1.8, -0.4}});
    }
  }
  return blocks;
}

/// How far along `direction` a ray from `origin` meets the block; beyond all if it does not.
double range_to(const Block& block, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double enter = 0, leave = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (block.low[axis] - origin[axis]) / direction[axis], b = (block.high[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : 1e9;
}

/// 3,500 rays in any direction between 30 degrees down and 25 up, up to 25 m, with 2 cm of noise; the ground is 2 m below the sensor.
Cloud scan(const std::vector<Block>& blocks, const Pose& at, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> azimuth(-M_PI, M_PI), height(std::sin(-30 * degree), std::sin(25 * degree));
  std::vector<Block> near;
  for (const Block& block : blocks)
    if (block.low.x() < at.translation.x() + 30 && block.high.x() > at.translation.x() - 30) near.push_back(block);
  Cloud cloud;
  for (int k = 0; k < 3500; ++k) {
    const double round = azimuth(random), up = height(random), level = std::sqrt(1 - up * up);
    const Eigen::Vector3d ray(level * std::cos(round), level * std::sin(round), up), direction = at.rotation * ray;
    double range = direction.z() < 0 ? (-2 - at.translation.z()) / direction.z() : 1e9;
    for (const Block& block : near) range = std::min(range, range_to(block, at.translation, direction));
    if (range < 25) cloud.add(((range + noise(random)) * ray).cast<float>());
  }
  return cloud;
}

struct Drive {
  Trajectory truth;
  std::vector<Frame> frames;
};

/// 36 frames, `step` [m] apart but for a stop, swinging gently from one side of the street to the other.
Drive drive_of(double step, std::uint32_t stop_from = 0, std::uint32_t stop_to = 0) {
  Drive d;
  std::mt19937 random(1);
  const auto blocks = street(1);
  double x = 0;
  for (std::uint32_t k = 0; k < 36; ++k) {
    if (k > 0 && (k <= stop_from || k > stop_to)) x += step;
    const Pose pose(exp_rotation({0, 0, std::atan(0.1 * std::cos(0.1 * x))}), {x, std::sin(0.1 * x), 0});
    d.truth.stamps.push_back(100 + 0.1 * k);
    d.truth.T_world_frame.push_back(pose);
    d.frames.push_back({k, scan(blocks, pose, random)});
  }
  return d;
}
const Drive& drive() {
  static const Drive made = drive_of(0.6);
  return made;
}
const Drive& slow_drive() {
  static const Drive made = drive_of(0.4);
  return made;
}

/// The trajectory with other motions: change(k, motion from frame k to k + 1).
template <class Change>
Trajectory changed(const Trajectory& truth, const Change& change) {
  Trajectory odometry = truth;
  for (std::uint32_t k = 0; k + 1 < truth.size(); ++k)
    odometry.T_world_frame[k + 1] = odometry.T_world_frame[k] * change(k, truth.T_world_frame[k].inverse() * truth.T_world_frame[k + 1]);
  return odometry;
}

Pose scaled(const Pose& motion, double factor) { return {exp_rotation(factor * log_rotation(motion.rotation)), factor * motion.translation}; }

CheckedOdometry check(const Trajectory& odometry, const Drive& of = drive()) {
  TestContext context;
  return check_odometry(odometry, [&](std::size_t k) { return std::make_shared<const Frame>(of.frames[k]); }, {}, context);
}

double worst_place(const Trajectory& a, const Trajectory& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, (a.T_world_frame[k].translation - b.T_world_frame[k].translation).norm());
  return worst;
}

constexpr std::uint32_t middle = 18;

/// One divergence that begins within 5 frames (which are compared at once) of the first wrong motion, and ends within as many of the last one.
void expect_one(const CheckedOdometry& checked, std::uint32_t first_wrong, std::uint32_t last_wrong) {
  ASSERT_EQ(checked.divergences.size(), 1u);
  const Divergence& d = checked.divergences[0];
  EXPECT_LE(d.first, first_wrong + 5);
  EXPECT_GE(d.first + 5, first_wrong);
  EXPECT_GE(d.last + 5, last_wrong);
  EXPECT_LE(d.last, last_wrong + 5);
}

// ---- odometry that is good enough -------------------------------------------------------------------------------------------

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
    return motion * Pose(exp_rotation({0, 0, 0.003 * g(random)}), {0.04 * g(random), 0.04 * g(random), 0.02 * g(random)});
  });
  EXPECT_TRUE(check(odometry).divergences.empty());
}

TEST(CheckOdometry, ContradictsNoneThatStopsWhereTheSensorDoes) {
  const Drive stopping = drive_of(0.6, 12, 24);
  ASSERT_LT((stopping.truth.T_world_frame[12].inverse() * stopping.truth.T_world_frame[24]).translation.norm(), 1e-9);
  EXPECT_TRUE(check(stopping.truth, stopping).divergences.empty());
}

// ---- odometry that is not ---------------------------------------------------------------------------------------------------

TEST(CheckOdometry, FindsWhereItDoublesItsPath) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) { return k >= middle ? scaled(motion, 2) : motion; });
  const auto checked = check(odometry);
  expect_one(checked, middle, 35);
  EXPECT_NEAR(checked.divergences[0].odometry_path / checked.divergences[0].registered_path, 2, 0.3);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItHalvesItsPath) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) { return k >= middle ? scaled(motion, 0.5) : motion; });
  const auto checked = check(odometry);
  expect_one(checked, middle, 35);
  EXPECT_NEAR(checked.divergences[0].odometry_path / checked.divergences[0].registered_path, 0.5, 0.15);
  EXPECT_LT(worst_place(checked.trajectory, drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItStandsStill) {
  const auto odometry = changed(slow_drive().truth, [](std::uint32_t k, const Pose& motion) { return k >= middle ? Pose() : motion; });
  const auto checked = check(odometry, slow_drive());
  expect_one(checked, middle, 35);
  EXPECT_LT(checked.divergences[0].odometry_path, 0.2 * checked.divergences[0].registered_path);
  EXPECT_LT(worst_place(checked.trajectory, slow_drive().truth), 1.5);
}

TEST(CheckOdometry, FindsWhereItStandsStillForAWhile) {
  const auto odometry =
      changed(slow_drive().truth, [](std::uint32_t k, const Pose& motion) { return k >= middle - 6 && k < middle + 6 ? Pose() : motion; });
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
      return k == middle ? Pose(motion.rotation * exp_rotation({0, 0, angle}), motion.translation) : motion;
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

/// Outside the divergence each motion is the odometry's, to the last bit that products of poses leave.
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
               kept = checked.trajectory.T_world_frame[k].inverse() * checked.trajectory.T_world_frame[k + 1];
    EXPECT_LT((given.inverse() * kept).translation.norm(), 1e-9) << k;
    EXPECT_LT(angle(given.inverse() * kept), 1e-9) << k;
  }
}

TEST(CheckOdometry, DoesNotDependOnWhereTheWorldIs) {
  const auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) { return k >= middle ? scaled(motion, 2) : motion; });
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

// ---- two scans --------------------------------------------------------------------------------------------------------------

TEST(ScanTarget, FitsATrueMotionBestOfAll) {
  const Drive& d = drive();
  for (const std::size_t k : {0u, 10u, 20u, 30u}) {
    ScanTarget target(d.frames[k].cloud, {});
    const auto source = asked_points(d.frames[k + 3].cloud, {});
    const Pose T = d.truth.T_world_frame[k].inverse() * d.truth.T_world_frame[k + 3];
    const double right = target.misfit(source, T);
    EXPECT_LT(right, 0.25);
    for (const double factor : {0.0, 0.5, 2.0}) EXPECT_LT(right, 0.6 * target.misfit(source, scaled(T, factor))) << k << ", " << factor;
  }
}

TEST(ScanTarget, AlignsFromAMetreAway) {
  const Drive& d = drive();
  ScanTarget target(d.frames[10].cloud, {});
  const auto source = asked_points(d.frames[12].cloud, {});
  const Pose T = d.truth.T_world_frame[10].inverse() * d.truth.T_world_frame[12];
  const Pose off = T * Pose(exp_rotation({0, 0, 2 * degree}), {0.8, 0.3, 0.1});
  const Pose error = T.inverse() * target.aligned(source, off);
  EXPECT_LT(error.translation.norm(), 0.15);
  EXPECT_LT(angle(error), 0.5 * degree);
}

TEST(ScanTarget, GivesTheFarthestMisfitWhereThereIsNothing) {
  const Drive& d = drive();
  ScanTarget target(d.frames[0].cloud, {}), empty(Cloud(), {});
  const auto source = asked_points(d.frames[1].cloud, {});
  EXPECT_EQ(target.misfit(source, Pose(Eigen::Quaterniond::Identity(), {0, 0, 500})), 1);
  EXPECT_EQ(target.misfit({}, Pose()), 1);
  EXPECT_EQ(empty.misfit(source, Pose()), 1);
  EXPECT_LE(source.size(), 500u);
  EXPECT_TRUE(asked_points(Cloud(), {}).empty());
}

// ---- the step ---------------------------------------------------------------------------------------------------------------

StepRun checking(const std::vector<Frame>& frames, const Trajectory& odometry) {
  StepRun step(*plumb_module());
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
  EXPECT_THAT(metrics.notes[0], testing::AllOf(testing::HasSubstr("jumps by 50"), testing::HasSubstr(std::string("from ") + times[0]),
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
  auto odometry = changed(drive().truth, [](std::uint32_t k, const Pose& motion) { return k >= middle ? scaled(motion, 2) : motion; });
  for (auto& pose : odometry.T_world_frame) pose.translation *= 0.1;
  TestContext context;
  auto step = checking(frames, odometry);
  step.with("scale", Metrics().add("scale", 0.1, ""));
  EXPECT_EQ(step.run<Metrics>("metrics", context).numbers.front().value, 1);
  const auto trajectory = step.run<Trajectory>("trajectory", context);
  double worst = 0;
  for (std::size_t k = 0; k < frames.size(); ++k)
    worst = std::max(worst, (trajectory.T_world_frame[k].translation - 0.1 * drive().truth.T_world_frame[k].translation).norm());
  EXPECT_LT(worst, 0.1);
}

TEST(CheckOdometry, HasNothingToCompareInOneFrameOrNone) {
  for (const std::size_t n : {0u, 1u}) {
    Trajectory few;
    few.stamps.assign(n, 5);
    few.T_world_frame.resize(n);
    TestContext context;
    const auto metrics = checking({drive().frames.begin(), drive().frames.begin() + static_cast<std::ptrdiff_t>(n)}, few).run<Metrics>("metrics", context);
    EXPECT_EQ(metrics.numbers[1].value, 0) << n;
  }
}

TEST(CheckOdometry, BelievesTheOdometryWhereScansAreEmpty) {
  std::vector<Frame> empty(drive().frames.size());
  TestContext context;
  EXPECT_EQ(checking(empty, drive().truth).run<Metrics>("metrics", context).numbers.front().value, 0);
}

TEST(CheckOdometry, RefusesATrajectoryOfOtherFrames) {
  auto frames = drive().frames;
  frames.resize(30);
  TestContext context;
  try {
    checking(frames, drive().truth).run<Metrics>("metrics", context);
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "there are 30 frames but 36 poses in the trajectory; wire the trajectory of these frames");
  }
}

}  // namespace
}  // namespace plumb
