#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/range.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::segment_poses {
namespace {

/// `n` poses, `step` [m] apart along x.
Trajectory along_x(int n, double step) {
  Trajectory trajectory;
  for (int k = 0; k < n; ++k) {
    trajectory.stamps.push_back(k);
    trajectory.T_world_frame.push_back(
        {exp_rotation({0, 0, 0.1 * k}), Eigen::Vector3d(step * k, 0, 0)});
  }
  return trajectory;
}

TEST(SegmentPoses, OfTheTrajectoryThatTheRangesWereCutFromAreTheRanges) {
  const Trajectory trajectory = along_x(10, 1);
  const auto ranges = ranges_from(trajectory, {0, 4, 7});
  TestContext context;
  const auto poses = StepUnderTest(*plumb_module())
                         .with("trajectory", trajectory)
                         .each("ranges", ranges)
                         .run<Poses>("poses", context);
  const Poses cut = poses_of(ranges);
  ASSERT_EQ(poses.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(poses.T_world_segment[k].translation, cut.T_world_segment[k].translation);
    EXPECT_EQ(poses.T_world_segment[k].rotation.coeffs(), cut.T_world_segment[k].rotation.coeffs());
  }
}

TEST(SegmentPoses, OfAnotherTrajectoryAreThoseOfTheMiddleFrames) {
  const auto ranges = ranges_from(along_x(10, 1), {0, 4, 7});
  TestContext context;
  const auto poses = StepUnderTest(*plumb_module())
                         .with("trajectory", along_x(10, 2))
                         .each("ranges", ranges)
                         .run<Poses>("poses", context);
  EXPECT_EQ(poses.T_world_segment[0].translation.x(), 4);
  EXPECT_EQ(poses.T_world_segment[1].translation.x(), 10);
  EXPECT_EQ(poses.T_world_segment[2].translation.x(), 16);
}

TEST(SegmentPoses, RefusesRangesOfALongerTrajectory) {
  const auto ranges = ranges_from(along_x(10, 1), {0, 4, 7});
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("trajectory", along_x(9, 1)).each("ranges", ranges);
  EXPECT_EQ(io::refusal([&] { step.run<Poses>("poses", context); }),
            "segment 2 has frames up to 10, the trajectory only 9: wire ranges of the same frames");
}

}  // namespace
}  // namespace plumb::segment_poses
