#include "submap.hpp"

#include <gtest/gtest.h>

#include "consistent.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/planar/room_testing.hpp"
#include "uncertainty.hpp"

namespace plumb::loops_submap {
namespace {

using planar::PlanarPose;
using Plan = planar::Walls;

Cloud scan(const Plan& plan, const PlanarPose& at) {
  Cloud cloud;
  for (int k = 0; k < 240; ++k) {
    const double angle = 2 * M_PI * k / 240,
                 nearest = planar::distance_to(plan, at, at.yaw + angle, 12);
    if (nearest < 12)
      cloud.add({static_cast<float>(nearest * std::cos(angle)),
                 static_cast<float>(nearest * std::sin(angle)), 0});
  }
  return cloud;
}

/// A square ring of corridors, 12 m x 12 m outside and 2 m wide, with niches at uneven places.
Plan ring(bool niches) {
  Plan plan = {{0, 0, 12, 0}, {12, 0, 12, 12}, {12, 12, 0, 12}, {0, 12, 0, 0},
               {2, 2, 10, 2}, {10, 2, 10, 10}, {10, 10, 2, 10}, {2, 10, 2, 2}};
  if (niches)
    for (const double at : {3.0, 4.7, 7.9}) {
      plan.push_back({at, 0, at, 0.3});
      plan.push_back({12, at + 0.4, 11.6, at + 0.4});
      plan.push_back({at + 1, 12, at + 1, 11.7});
      plan.push_back({0, at - 0.5, 0.4, at - 0.5});
    }
  return plan;
}

struct Drive {
  std::vector<PlanarPose> truth;
  Poses drifted;
  std::vector<Segment> segments;
};

/// Once round the ring and a quarter more, a scan every 0.25 m; the heading drifts by `drift`
/// [rad/m].
Drive drive(const Plan& plan, double drift) {
  Drive result;
  PlanarPose at{1, 1, 0}, guess = at;
  const auto put = [&] {
    result.truth.push_back(at);
    result.drifted.T_world_segment.push_back(in_space(guess));
    result.segments.push_back(segment_of(scan(plan, at)));
  };
  put();
  for (int side = 0; side < 5; ++side) {
    for (int k = 0; k < 40; ++k) {
      at = at * PlanarPose{0.25, 0, 0};
      guess = guess * PlanarPose{0.25, 0, 0.25 * drift};
      put();
    }
    at = at * PlanarPose{0, 0, M_PI / 2}, guess = guess * PlanarPose{0, 0, M_PI / 2};
  }
  return result;
}

Loops loops_of(const Drive& drive, const LoopOptions& options = {}) {
  TestContext context;
  return find_loops(
      [&](std::size_t k) { return std::make_shared<const Segment>(drive.segments[k]); },
      drive.drifted, nullptr, options, context);
}

double wrong_by(const Drive& drive, const RelativePose& loop) {
  const PlanarPose truth = drive.truth[loop.i].inverse() * drive.truth[loop.j],
                   found = planar::projected(loop.T_i_j);
  return std::hypot(truth.x - found.x, truth.y - found.y);
}

TEST(LoopsSubmap, ClosesARoundWhoseHeadingDrifted) {
  const Drive round = drive(ring(true), 0.002);
  const Loops loops = loops_of(round);
  EXPECT_GE(loops.constraints.relative.size(), 3u);
  EXPECT_TRUE(loops.constraints.planar);
  for (const auto& loop : loops.constraints.relative) {
    EXPECT_LT(loop.i, loop.j);
    EXPECT_LT(wrong_by(round, loop), 0.1) << loop.i << ' ' << loop.j;
  }
}

TEST(LoopsSubmap, RefusesWhatIsNotUnique) {
  // Rows of equal pillars along a straight hall: shifted by one pillar it fits as well.
  Plan hall = {{0, 0, 60, 0}, {0, 3, 60, 3}};
  for (int k = 0; k < 60; ++k) hall.push_back({k + 0.5, 1.4, k + 0.5, 1.6});
  Drive there_and_back;
  PlanarPose at{22, 0.7, 0};
  for (int k = 0; k < 80; ++k) {
    at = at * PlanarPose{k < 40 ? 0.4 : -0.4, 0, 0};
    there_and_back.truth.push_back(at);
    // The path is believed to be 3 % longer than it is.
    there_and_back.drifted.T_world_segment.push_back(
        planar::in_space({22 + 1.03 * (at.x - 22), at.y, 0}));
    there_and_back.segments.push_back(segment_of(scan(hall, at)));
  }
  const Loops loops = loops_of(there_and_back);
  EXPECT_GT(loops.counts.ambiguous, 0u);
  for (const auto& loop : loops.constraints.relative)
    EXPECT_LT(wrong_by(there_and_back, loop), 0.3);
}

TEST(LoopsSubmap, FindsNoLoopOnAStraightPath) {
  Plan hall = {{0, 0, 40, 0}, {0, 3, 40, 3}};
  Drive straight;
  for (int k = 0; k < 60; ++k) {
    const PlanarPose at{5 + 0.4 * k, 1.5, 0};
    straight.truth.push_back(at);
    straight.drifted.T_world_segment.push_back(in_space(at));
    straight.segments.push_back(segment_of(scan(hall, at)));
  }
  EXPECT_TRUE(loops_of(straight).constraints.relative.empty());
}

TEST(LoopsSubmap, StepSaysThatPosesOfOthersWereWired) {
  StepUnderTest step(*plumb_module());
  TestContext context;
  step.each("segments", std::vector<Segment>(3)).with("poses", Poses());
  EXPECT_THROW(step.run<Constraints>("constraints", context), Error);
}

TEST(Consistent, DropsTheLoopThatNoOtherAgreesWith) {
  Poses poses;
  for (int k = 0; k < 100; ++k)
    poses.T_world_segment.push_back(
        planar::in_space({0.5 * (k < 50 ? k : 100 - k), k < 50 ? 0.0 : 1.0, 0}));
  std::vector<RelativePose> loops;
  for (const std::uint32_t j : {70u, 74u, 78u})
    loops.push_back({100 - j, j, poses.relative(100 - j, j), Matrix6d::Identity()});
  RelativePose wrong{24, 76, poses.relative(24, 76), Matrix6d::Identity()};
  wrong.T_i_j.translation.x() += 1.5;
  loops.push_back(wrong);
  const auto kept = supported(loops, poses, {});
  ASSERT_EQ(kept.size(), 3u);
  for (const auto& loop : kept) EXPECT_NE(loop.j, 76u);
  EXPECT_EQ(supported(loops, poses, {0, 10, 0.3, 0.02}).size(), 4u);
}

TEST(Paths, AreShorterOverAKnownLoop) {
  Poses poses;
  for (int k = 0; k <= 10; ++k) poses.T_world_segment.push_back(planar::in_space({1.0 * k, 0, 0}));
  Constraints loops;
  loops.relative.push_back({0, 10, Pose(), Matrix6d::Identity()});
  EXPECT_DOUBLE_EQ(Paths(poses, nullptr, 0.3, 1).from(10)[1], 9);
  EXPECT_DOUBLE_EQ(Paths(poses, &loops, 0.3, 1).from(10)[1], 2);
  loops.relative[0].j = 11;
  EXPECT_THROW(Paths(poses, &loops, 0.3, 1), Error);
}

}  // namespace
}  // namespace plumb::loops_submap
