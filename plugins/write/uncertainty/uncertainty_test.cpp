#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <random>
#include <sstream>

#include "plumb/data/document.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "table.hpp"

namespace plumb::write_uncertainty {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A segment's pose with a covariance of [t; q.vec] in its own axes.
AbsolutePose known(std::uint32_t i, const Pose& T_world_i, const Matrix6d& covariance) {
  return {i, T_world_i, covariance.inverse()};
}
Matrix6d diagonal(const Eigen::Vector3d& t, const Eigen::Vector3d& q) {
  Vector6d d;
  d << t, q;
  return d.asDiagonal();
}
PoseUncertainty of_size(double size) {
  return {size * Eigen::Matrix3d::Identity(), 2 * size * Eigen::Matrix3d::Identity()};
}
/// `sizes[k]` frames in segment k.
std::vector<FrameRange> ranges_of(const std::vector<std::uint32_t>& sizes) {
  std::vector<FrameRange> ranges;
  std::uint32_t first = 0;
  for (const auto size : sizes) {
    ranges.emplace_back();
    ranges.back().first = first;
    ranges.back().end = first += size;
  }
  return ranges;
}
Trajectory along_x(std::size_t frames) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < frames; ++k) {
    trajectory.stamps.push_back(1e9 + 0.1 * static_cast<double>(k));
    trajectory.T_world_frame.push_back(
        {Eigen::Quaterniond::Identity(), {static_cast<double>(k), 0.5, -2}});
  }
  return trajectory;
}
std::vector<std::vector<double>> rows_of(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line, cell;
  std::getline(lines, line);  // the names
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST(UncertaintyOfSegments, TurnsPositionAndRotationIntoTheWorldAndCountsWholeAngles) {
  const Pose facing_y(exp_rotation({0, 0, M_PI / 2}), {10, 20, 0});
  Constraints constraints;
  constraints.absolute = {known(1, facing_y, diagonal({4, 1, 0.25}, {0.01, 0.02, 0.03}))};
  const auto segments = uncertainty_of(constraints, 3);
  ASSERT_EQ(segments.size(), 3u);
  EXPECT_LT(
      (segments[1].position - Eigen::Matrix3d(Eigen::Vector3d(1, 4, 0.25).asDiagonal())).norm(),
      1e-9)
      << "its x points along the world's y";
  EXPECT_LT((segments[1].rotation - Eigen::Matrix3d(Eigen::Vector3d(0.08, 0.04, 0.12).asDiagonal()))
                .norm(),
            1e-9)
      << "and so do its rolls";
}

TEST(UncertaintyOfSegments, IsThatOfPosesDrawnAtRandom) {
  Matrix6d root;  // any covariance: centimetres and milliradians that depend on each other
  Random numbers(5);
  for (int k = 0; k < 36; ++k)
    root(k / 6, k % 6) = (k / 6 < 3 ? 0.05 : 0.004) * (2 * numbers.uniform() - 1);
  root += diagonal({0.05, 0.05, 0.05}, {0.004, 0.004, 0.004});
  const Pose T(exp_rotation({0.4, -0.2, 1.1}), {100, 50, 3});
  Constraints constraints;
  constraints.absolute = {known(0, T, root * root.transpose())};
  const PoseUncertainty uncertainty = uncertainty_of(constraints, 1)[0];

  std::mt19937 random(1);
  std::normal_distribution<double> g(0, 1);
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero(), rotation = Eigen::Matrix3d::Zero();
  constexpr int draws = 40000;
  for (int k = 0; k < draws; ++k) {
    const Vector6d e = root * Vector6d::NullaryExpr([&](Eigen::Index) { return g(random); });
    Eigen::Quaterniond q;
    q.vec() = e.tail<3>();
    q.w() = std::sqrt(1 - q.vec().squaredNorm());
    const Pose drawn = T * Pose(q, e.head<3>());
    const Eigen::Vector3d t = drawn.translation - T.translation,
                          w = log_rotation(drawn.rotation *
                                           T.rotation.conjugate());  // in the world
    position += t * t.transpose() / draws;
    rotation += w * w.transpose() / draws;
  }
  EXPECT_LT((uncertainty.position - position).norm(), 0.03 * position.norm());
  EXPECT_LT((uncertainty.rotation - rotation).norm(), 0.03 * rotation.norm());
}

TEST(UncertaintyOfSegments, IsZeroForThoseHeldFixed) {
  Constraints constraints;
  constraints.absolute = {known(1, Pose(), Matrix6d::Identity())};
  EXPECT_TRUE(uncertainty_of(constraints, 2)[0].position.isZero());
  EXPECT_TRUE(uncertainty_of(constraints, 2)[0].rotation.isZero());
}

TEST(UncertaintyOfSegments, RefusesASegmentThatDoesNotExist) {
  Constraints constraints;
  constraints.absolute = {known(3, Pose(), Matrix6d::Identity())};
  EXPECT_THROW(uncertainty_of(constraints, 3), Error);
  EXPECT_NO_THROW(uncertainty_of(constraints, 4));
}

TEST(UncertaintyOfFrames, GrowsEvenlyFromTheFirstFrameThatAllIsRelativeTo) {
  // Middle frames 2, 5 and 9; the first segment is held fixed.
  const auto frames = of_frames({of_size(0), of_size(3), of_size(7)}, ranges_of({4, 3, 5}), 12);
  std::vector<double> size;
  for (const auto& frame : frames) {
    size.push_back(frame.position(1, 1));
    EXPECT_NEAR(frame.rotation(2, 2), 2 * size.back(), 1e-12);
  }
  EXPECT_THAT(size,
              testing::Pointwise(testing::DoubleNear(1e-12),
                                 std::vector<double>{0, 0.6, 1.2, 1.8, 2.4, 3, 4, 5, 6, 7, 7, 7}));
}

TEST(UncertaintyOfFrames, GrowsEvenlyFromOneMiddleFrameToTheNext) {
  const auto frames =
      of_frames({of_size(1), of_size(4)}, ranges_of({4, 3}), 7);  // middle frames 2 and 5
  std::vector<double> size;
  for (const auto& frame : frames) size.push_back(frame.position(1, 1));
  EXPECT_THAT(size, testing::Pointwise(testing::DoubleNear(1e-12),
                                       std::vector<double>{1, 1, 1, 2, 3, 4, 4}));
}

TEST(UncertaintyOfFrames, IsThatOfASegmentAlone) {
  for (const auto& frame : of_frames({of_size(2)}, ranges_of({5}), 5))
    EXPECT_EQ(frame.position(0, 0), 2);
}

TEST(UncertaintyTable, HasALineOfNamesAndANumberForEachOfThem) {
  PoseUncertainty uncertainty;
  uncertainty.position << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  uncertainty.rotation.diagonal() << 1e-4, 4e-4, 9e-4;
  const auto text = uncertainty_table(along_x(2), {of_size(0), uncertainty});
  EXPECT_THAT(text, StartsWith("stamp,x,y,z,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz,sigma_roll,"
                               "sigma_pitch,sigma_yaw\n"));
  const auto rows = rows_of(text);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_THAT(rows[0],
              testing::Pointwise(testing::DoubleNear(1e-9),
                                 std::vector<double>{1e9, 0, 0.5, -2, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_THAT(rows[1], testing::Pointwise(testing::DoubleNear(1e-6),
                                          std::vector<double>{1e9 + 0.1, 1, 0.5, -2, 1, 2, 3, 4, 5,
                                                              6, 0.01, 0.02, 0.03}));
}

TEST(UncertaintyTable, GivesDeviationsAboutTheAxesOfEachFrame) {
  Trajectory trajectory = along_x(2);
  trajectory.T_world_frame[1].rotation = exp_rotation({0, 0, M_PI / 2});
  PoseUncertainty uncertainty;  // about the world's x, y and z
  uncertainty.rotation.diagonal() << 1e-4, 4e-4, 9e-4;
  const auto rows = rows_of(uncertainty_table(trajectory, {uncertainty, uncertainty}));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(rows[0][10], 0.01, 1e-7);
  EXPECT_NEAR(rows[0][11], 0.02, 1e-7);
  EXPECT_NEAR(rows[1][10], 0.02, 1e-7) << "its x points along the world's y";
  EXPECT_NEAR(rows[1][11], 0.01, 1e-7);
  EXPECT_NEAR(rows[1][12], 0.03, 1e-7);
}

TEST(UncertaintyTable,
     OfAFrameBetweenTwoSegmentsThatAreTurnedHasTheDeviationsOfTheOneItIsTurnedLike) {
  // Both know their rotation equally well in the world; the second is yawed by a quarter turn, so
  // that its roll is the first one's pitch.
  const Pose along, across(exp_rotation({0, 0, M_PI / 2}), {4, 0, 0});
  Constraints constraints;
  constraints.absolute = {known(0, along, diagonal({1, 1, 1}, {2.5e-5, 1e-4, 2.25e-4})),
                          known(1, across, diagonal({1, 1, 1}, {1e-4, 2.5e-5, 2.25e-4}))};
  Trajectory trajectory =
      along_x(6);  // middle frames 1 and 4; 2 is turned like the first segment, 3 like the second
  for (std::size_t k = 3; k < 6; ++k) trajectory.T_world_frame[k].rotation = across.rotation;
  const auto rows = rows_of(uncertainty_table(
      trajectory, of_frames(uncertainty_of(constraints, 2), ranges_of({3, 3}), 6)));
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(rows[k][10], k < 3 ? 0.01 : 0.02, 1e-6) << "roll of frame " << k;
    EXPECT_NEAR(rows[k][11], k < 3 ? 0.02 : 0.01, 1e-6) << "pitch of frame " << k;
    EXPECT_NEAR(rows[k][12], 0.03, 1e-6);
  }
}

TEST(UncertaintyTable, KeepsLargeStampsAndUtmCoordinates) {
  Trajectory trajectory = along_x(1);
  trajectory.stamps[0] = 1699999999.123456;
  trajectory.T_world_frame[0].translation = {412345.123, 5654321.456, 180.25};
  const auto rows = rows_of(uncertainty_table(trajectory, {of_size(1)}));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(rows[0][0], 1699999999.123456, 1e-6);
  EXPECT_NEAR(rows[0][2], 5654321.456, 1e-6);
}

// ---- the step
// ---------------------------------------------------------------------------------------------------------------------

/// Three segments of three frames; the first fixed.
StepUnderTest wired() {
  Constraints uncertainty;
  uncertainty.absolute = {known(1, Pose(), diagonal({0.04, 0.03, 0.02}, {1e-6, 1e-6, 1e-6})),
                          known(2, Pose(), diagonal({0.2, 0.1, 0.06}, {1e-6, 1e-6, 1e-6}))};
  StepUnderTest step(*plumb_module());
  step.with("uncertainty", uncertainty)
      .each("ranges", ranges_of({3, 3, 3}))
      .with("trajectory", along_x(9));
  return step;
}

TEST(WriteUncertainty, WritesALineAFrameUnderItsName) {
  TestContext context;
  EXPECT_EQ(wired().run<Document>("document", context).name, "uncertainty.csv");
  const auto document =
      wired().set("name", std::string("sigma.csv")).run<Document>("document", context);
  EXPECT_EQ(document.name, "sigma.csv");
  const auto rows = rows_of(document.bytes.text());
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_EQ(rows[0][4], 0);
  EXPECT_NEAR(rows[1][4], 0.01, 1e-6);  // a quarter of the way to the second middle
  EXPECT_NEAR(rows[4][4], 0.04, 1e-6);
  EXPECT_NEAR(rows[7][4], 0.2, 1e-6);
  EXPECT_NEAR(rows[4][10], 2e-3, 1e-6);
  EXPECT_TRUE(context.warnings.empty());
}

TEST(WriteUncertainty, GivesTheMedianAndTheGreatestDeviationOfThePositions) {
  TestContext context;
  const auto numbers = wired().run<Metrics>("metrics", context).numbers;
  ASSERT_EQ(numbers.size(), 2u);
  EXPECT_EQ(numbers[0].name, "position_sigma_median");
  EXPECT_NEAR(numbers[0].value, 0.3,
              1e-9);  // of the middle frame, in the middle of the second segment
  EXPECT_EQ(numbers[1].name, "position_sigma_max");
  EXPECT_NEAR(numbers[1].value, 0.6, 1e-9);
  EXPECT_EQ(numbers[1].unit, "m");
}

TEST(WriteUncertainty, WarnsWhereTheSolverGaveNone) {
  TestContext context;
  const auto document =
      wired().with("uncertainty", Constraints()).run<Document>("document", context);
  EXPECT_EQ(rows_of(document.bytes.text()).size(), 9u);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_THAT(context.warnings[0], HasSubstr("uncertainty: true"));
}

TEST(WriteUncertainty, RefusesRangesOfAnotherTrajectoryOrFewerSegments) {
  const auto refusal = [](const StepUnderTest& step) {
    TestContext context;
    return io::refusal([&] { step.run<Document>("document", context); });
  };
  EXPECT_THAT(refusal(wired().with("trajectory", along_x(10))),
              HasSubstr("do not cover the trajectory of 10 frames"));
  EXPECT_THAT(refusal(wired().each("ranges", std::vector<FrameRange>())),
              HasSubstr("do not cover the trajectory"));
  EXPECT_THAT(refusal(wired().each("ranges", ranges_of({4, 5}))),
              HasSubstr("names segment 2, but got 2 segments"));
}

TEST(WriteUncertainty, RefusesANameWithAFolder) {
  const Step& step = *plumb_module()->steps[0];
  EXPECT_THROW(step.parameters({{"name", std::string("../x.csv")}}), Error);
  EXPECT_THROW(step.parameters({{"name", std::string()}}), Error);
}

}  // namespace
}  // namespace plumb::write_uncertainty
