#include "correction.hpp"

#include <gmock/gmock.h>

#include "plumb/data/error.hpp"
#include "plumb/slam/range.hpp"

namespace plumb::apply_correction {
namespace {

Trajectory drive(std::size_t frames) {
  Trajectory t;
  for (std::size_t k = 0; k < frames; ++k) {
    const double s = static_cast<double>(k);
    t.stamps.push_back(0.1 * s);
    t.T_world_frame.push_back({exp_rotation({0, 0, 0.03 * s}), {2 * s, 0.01 * s * s, 0}});
  }
  return t;
}

struct Drive {
  Trajectory trajectory = drive(40);
  std::vector<FrameRange> ranges = ranges_from(trajectory, {0, 10, 20, 30});
  Poses poses = poses_of(ranges);
};

double distance(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() + angle(a.inverse() * b);
}

TEST(Correction, LeavesATrajectoryWhoseSegmentsStay) {
  const Drive run;
  for (const bool blend : {true, false}) {
    const auto result = corrected(run.trajectory, run.ranges, run.poses, blend);
    EXPECT_EQ(result.stamps, run.trajectory.stamps);
    for (std::size_t k = 0; k < result.size(); ++k)
      EXPECT_LT(distance(result.T_world_frame[k], run.trajectory.T_world_frame[k]), 1e-12);
  }
}

TEST(Correction, IsExactForOneRigidMotionOfAllSegments) {
  Drive run;
  const Pose motion(exp_rotation({0.1, -0.2, 1.5}), {500, -300, 20});
  for (auto& pose : run.poses.T_world_segment) pose = motion * pose;
  const auto result = corrected(run.trajectory, run.ranges, run.poses, true);
  for (std::size_t k = 0; k < result.size(); ++k)
    EXPECT_LT(distance(result.T_world_frame[k], motion * run.trajectory.T_world_frame[k]), 1e-9);
}

TEST(Correction, MakesNoStepWhereASegmentEnds) {
  Drive run;
  run.poses.T_world_segment[1].translation += Eigen::Vector3d(0, 1, 0);
  const auto largest_step = [&](bool blend) {
    const auto result = corrected(run.trajectory, run.ranges, run.poses, blend);
    double largest = 0;
    for (std::size_t k = 1; k < result.size(); ++k)
      largest = std::max(largest,
                         distance(result.T_world_frame[k - 1].inverse() * result.T_world_frame[k],
                                  run.trajectory.T_world_frame[k - 1].inverse() *
                                      run.trajectory.T_world_frame[k]));
    return largest;
  };
  EXPECT_NEAR(largest_step(false), 1.0, 1e-9);
  EXPECT_LT(largest_step(true), 0.12);  // 1 m over about 10 frames
}

TEST(Correction, TakesEachSegmentsOwnPoseAtItsMiddle) {
  Drive run;
  for (std::size_t s = 0; s < 4; ++s)
    run.poses.T_world_segment[s].translation.z() += static_cast<double>(s * s);
  const auto result = corrected(run.trajectory, run.ranges, run.poses, true);
  for (std::size_t s = 0; s < 4; ++s)
    EXPECT_LT(distance(result.T_world_frame[10 * s + 5], run.poses.T_world_segment[s]), 1e-12);
}

TEST(Correction, BlendsByFramesWhereNothingWasTravelled) {
  Drive run;
  for (auto& pose : run.trajectory.T_world_frame) pose = Pose();
  run.ranges = ranges_from(run.trajectory, {0, 10, 20, 30});
  run.poses = poses_of(run.ranges);
  run.poses.T_world_segment[1].translation.x() = 1;
  const auto result = corrected(run.trajectory, run.ranges, run.poses, true);
  EXPECT_NEAR(result.T_world_frame[10].translation.x(), 0.5, 1e-12);
}

TEST(Correction, TakesASingleSegment) {
  Drive run;
  run.ranges = ranges_from(run.trajectory, {0});
  run.poses = poses_of(run.ranges);
  EXPECT_EQ(corrected(run.trajectory, run.ranges, run.poses, true).size(), 40u);
}

TEST(Correction, RefusesPosesAndRangesThatDoNotFit) {
  Drive run;
  auto fewer = run.poses;
  fewer.T_world_segment.pop_back();
  EXPECT_THROW(corrected(run.trajectory, run.ranges, fewer, true), Error);
  auto gap = run.ranges;
  gap[2].first = 25;
  EXPECT_THROW(corrected(run.trajectory, gap, run.poses, true), Error);
  EXPECT_THROW(corrected(drive(45), run.ranges, run.poses, true), Error);
}

}  // namespace
}  // namespace plumb::apply_correction
