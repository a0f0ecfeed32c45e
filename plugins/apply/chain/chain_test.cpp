#include "chain.hpp"

#include <cmath>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/planar/planar_pose.hpp"

namespace plumb::apply_chain {
namespace {

double distance(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() + angle(a.inverse() * b);
}

/// A true drive in the plane, odometry that drifts from it, and registrations that are exact.
struct Drive {
  Poses truth, odometry;
  Edges edges;
  std::vector<Registration> registrations;

  explicit Drive(std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs = {
                     {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}) {
    for (int k = 0; k < 6; ++k) {
      truth.T_world_segment.push_back(planar::in_space({0.5 * k, 0.1 * k * k, 0.3 * k}));
      odometry.T_world_segment.push_back(
          planar::in_space({0.55 * k, 0.1 * k * k - 0.04 * k, 0.33 * k}));
    }
    edges.segments = 6;
    for (const auto& [i, j] : pairs) {
      edges.list.push_back({i, j});
      Registration r;
      r.T_i_j = truth.relative(i, j);
      r.information = 100 * Matrix6d::Identity();
      r.accepted = true;
      r.iterations = 4, r.mae = 0.02f, r.overlap = 0.5f;
      registrations.push_back(r);
    }
  }
  Chained chain() const { return chained(odometry, edges, registrations, {}); }
};

TEST(ApplyChain, BringsExactRegistrationsToTheTruth) {
  const Drive drive;
  const auto result = drive.chain();
  for (int k = 0; k < 6; ++k)
    EXPECT_LT(distance(result.poses.T_world_segment[k], drive.truth.T_world_segment[k]), 1e-12)
        << k;
  ASSERT_EQ(result.constraints.relative.size(), 5u);
  EXPECT_TRUE(result.constraints.planar);
  EXPECT_EQ(result.constraints.relative[2].information(0, 0), 100);
  EXPECT_EQ(result.constraints.relative[2].information(5, 5), 400);  // of q.z, half the angle
}

TEST(ApplyChain, StartsAtTheFirstInitialPose) {
  Drive drive;
  const Pose home = planar::in_space({7, 8, 2});
  for (Pose& pose : drive.odometry.T_world_segment) pose = home * pose;
  EXPECT_LT(distance(drive.chain().poses.T_world_segment[5], home * drive.truth.T_world_segment[5]),
            1e-12);
}

TEST(ApplyChain, PutsTheInitialMotionWhereARegistrationIsNotAccepted) {
  Drive drive;
  drive.registrations[2].accepted = false;
  const auto result = drive.chain();
  EXPECT_EQ(result.replaced, 1u);
  EXPECT_LT(distance(result.poses.relative(2, 3), drive.odometry.relative(2, 3)), 1e-12);
  EXPECT_LT(distance(result.poses.relative(3, 5), drive.truth.relative(3, 5)), 1e-12);
  const Matrix6d& information = result.constraints.relative[2].information;
  EXPECT_DOUBLE_EQ(information(0, 0), 4);                          // 0.5 m
  EXPECT_DOUBLE_EQ(information(5, 5), 4 / std::pow(30 * deg, 2));  // by half the angle
}

TEST(ApplyChain, PutsDroppedSegmentsBetweenTheirNeighbours) {
  const Drive drive({{0, 1}, {1, 4}, {4, 5}});
  const auto result = drive.chain();
  EXPECT_EQ(result.interpolated, 2u);
  const auto& T = result.poses.T_world_segment;
  EXPECT_LT(distance(T[4], drive.truth.T_world_segment[4]), 1e-12);
  EXPECT_LT(distance(T[2], interpolate(T[1], T[4], 1. / 3)), 1e-12);
  EXPECT_LT(distance(T[3], interpolate(T[1], T[4], 2. / 3)), 1e-12);
}

TEST(ApplyChain, FollowsTheInitialMotionOutsideOfTheChain) {
  const Drive drive({{2, 3}});
  const auto& T = drive.chain().poses;
  EXPECT_LT(distance(T.T_world_segment[2], drive.odometry.T_world_segment[2]), 1e-12);
  EXPECT_LT(distance(T.T_world_segment[0], drive.odometry.T_world_segment[0]), 1e-12);
  EXPECT_LT(distance(T.relative(3, 5), drive.odometry.relative(3, 5)), 1e-12);
}

TEST(ApplyChain, StartsAnewWhereNoEdgeEnds) {
  const Drive drive({{0, 1}, {3, 4}});
  const auto result = drive.chain();
  EXPECT_EQ(result.starts, 1u);
  EXPECT_LT(distance(result.poses.relative(1, 3), drive.odometry.relative(1, 3)), 1e-12);
  EXPECT_LT(distance(result.poses.relative(3, 4), drive.truth.relative(3, 4)), 1e-12);
}

TEST(ApplyChain, BelievesTheNearestAcceptedOfSeveralEdges) {
  Drive drive({{0, 1}, {0, 2}, {1, 2}});
  drive.registrations[1].T_i_j.translation.x() += 1;
  EXPECT_LT(distance(drive.chain().poses.T_world_segment[2], drive.truth.T_world_segment[2]),
            1e-12);
  drive.registrations[1].accepted = true, drive.registrations[2].accepted = false;
  EXPECT_NEAR(distance(drive.chain().poses.T_world_segment[2], drive.truth.T_world_segment[2]), 1,
              1e-9);
}

TEST(ApplyChain, IsNotPlanarWhereAMotionLeavesThePlane) {
  Drive drive;
  drive.registrations[1].T_i_j.rotation = exp_rotation({0.01, 0, 0});
  EXPECT_FALSE(drive.chain().constraints.planar);
}

TEST(ApplyChain, KeepsInitialPosesWithoutAnyEdge) {
  const Drive drive(std::vector<std::pair<std::uint32_t, std::uint32_t>>{});
  const auto result = drive.chain();
  for (int k = 0; k < 6; ++k)
    EXPECT_EQ(distance(result.poses.T_world_segment[k], drive.odometry.T_world_segment[k]), 0);
}

TEST(ApplyChain, RefusesPosesOfOtherSegments) {
  Drive drive;
  drive.odometry.T_world_segment.pop_back();
  EXPECT_THROW(drive.chain(), Error);
}

TEST(ApplyChain, CountsAndWarnsOnce) {
  Drive drive;
  drive.registrations[1].accepted = drive.registrations[2].accepted = false;
  TestContext context;
  const auto metrics = StepUnderTest(*plumb_module())
                           .with("poses", drive.odometry)
                           .each("registrations", drive.registrations, drive.edges)
                           .run<Metrics>("metrics", context);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_EQ(
      context.warnings[0],
      "2 of 5 registrations are not accepted: the initial motion stands there, with little weight");
  EXPECT_EQ(metrics.numbers[1].value, 4);
  EXPECT_NEAR(metrics.numbers[2].value, 0.02, 1e-6);
  EXPECT_EQ(metrics.numbers[3].name, "mae_median");
  EXPECT_NEAR(metrics.numbers[3].value, 0.02, 1e-6);
  EXPECT_EQ(metrics.numbers[5].name, "not_accepted");
  EXPECT_EQ(metrics.numbers[5].value, 2);
}

}  // namespace
}  // namespace plumb::apply_chain
