#include "track.hpp"

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/segment.hpp"
#include "plumb/slam/step.hpp"
#include "shared/planar/room_testing.hpp"

namespace plumb::track_sliding_window {
namespace {

/// A way round a room of 8 m x 6 m, its scans, and odometry that drifts from it.
struct Drive {
  std::vector<PlanarPose> truth;
  std::vector<Cloud> scans;
  Poses odometry;
  Edges chain;

  explicit Drive(std::size_t count = 60, double slip = 1.05) {
    PlanarPose wheels;
    for (std::size_t k = 0; k < count; ++k) {
      const double phase = 0.05 * static_cast<double>(k);
      truth.push_back({0.6 * std::cos(phase), 0.6 * std::sin(phase), phase});
      scans.push_back(planar::room_scan<Cloud>(truth[k], 360, 0.01, 10 + static_cast<unsigned>(k)));
      if (k > 0) {
        const PlanarPose step = truth[k - 1].inverse() * truth[k];
        wheels = wheels * PlanarPose{slip * step.x, slip * step.y, slip * step.yaw};
        chain.list.push_back({static_cast<std::uint32_t>(k - 1), static_cast<std::uint32_t>(k)});
      }
      odometry.T_world_segment.push_back(in_space(wheels));
    }
    chain.segments = static_cast<std::uint32_t>(count);
  }
  void without_odometry() {
    for (Pose& pose : odometry.T_world_segment) pose = Pose();
  }
  Tracked follow(const TrackOptions& options) const {
    std::vector<const Cloud*> pointers;
    for (const Cloud& scan : scans) pointers.push_back(&scan);
    return track(pointers, odometry, chain, options);
  }
  /// How far the pose of scan k is off, [m] and [rad] together; all as seen from scan 0.
  double error(const Poses& poses, std::size_t k) const {
    const PlanarPose is = planar::projected(poses.relative(0, k)),
                     should = truth[0].inverse() * truth[k];
    return off(is, should) + std::abs(planar::wrapped(is.yaw - should.yaw));
  }
};

TrackOptions lines() {
  TrackOptions options;
  options.icp.stop = planar::Stop::ratio, options.icp.metric = planar::Metric::line,
  options.icp.start_sigma = 0.05;
  return options;
}

TEST(Track, FollowsTheTruthWhereOdometryDrifts) {
  const Drive drive;
  const Tracked tracked = drive.follow(lines());
  EXPECT_GT(drive.error(drive.odometry, 59), 0.1);
  for (std::size_t k = 0; k < 60; ++k) EXPECT_LT(drive.error(tracked.poses, k), 0.02) << k;
  EXPECT_EQ(tracked.registered, 59u);
  EXPECT_EQ(tracked.unfit, 0u);
  EXPECT_EQ(tracked.restarts, 0u);
  EXPECT_LT(tracked.iterations / 59, 5);
}

TEST(Track, NeedsNoOdometry) {
  Drive drive;
  drive.without_odometry();
  const Tracked tracked = drive.follow(lines());
  for (std::size_t k = 0; k < 60; ++k) EXPECT_LT(drive.error(tracked.poses, k), 0.03) << k;
}

TEST(Track, IsBetterAgainstASubmapThanAgainstSingleScans) {
  const Drive drive(120);
  TrackOptions submap = lines(), single = lines();
  single.frames = 1, single.min_translation = 0;
  const auto worst = [&](const TrackOptions& options) {
    const Tracked tracked = drive.follow(options);
    double most = 0;
    for (std::size_t k = 0; k < 120; ++k) most = std::max(most, drive.error(tracked.poses, k));
    return most;
  };
  EXPECT_LT(worst(submap), 0.7 * worst(single));
}

TEST(Track, SearchesWhereTheRobotWasTurnedAround) {
  Drive drive(40);
  // From scan 20 on the robot stands turned by 2 rad and its wheels do not know.
  for (std::size_t k = 20; k < 40; ++k) {
    drive.truth[k] = drive.truth[k] * PlanarPose{0, 0, 2};
    drive.scans[k] =
        planar::room_scan<Cloud>(drive.truth[k], 360, 0.01, 50 + static_cast<unsigned>(k));
  }
  const Tracked tracked = drive.follow(lines());
  EXPECT_LT(drive.error(tracked.poses, 39), 0.04);
  EXPECT_GE(tracked.searched, 1u);
  TrackOptions blind = lines();
  blind.search_below.reset();
  EXPECT_GT(drive.error(drive.follow(blind).poses, 39), 1);
}

TEST(Track, TakesTheOdometryWhereAScanFitsNowhereAndGoesOnAfterIt) {
  Drive drive(40, 1.0);
  for (std::size_t k = 0; k < drive.scans[20].size(); ++k)
    drive.scans[20].x[k] = 40 + 0.2f * static_cast<float>(k),
    drive.scans[20].y[k] = 0;  // a wall far off
  const Tracked tracked = drive.follow(lines());
  EXPECT_EQ(tracked.unfit, 1u);
  EXPECT_EQ(tracked.restarts, 0u);
  for (std::size_t k = 0; k < 40; ++k) EXPECT_LT(drive.error(tracked.poses, k), 0.02) << k;
}

TEST(Track, StartsTheWindowAgainWhenPatienceIsUsedUp) {
  Drive drive(40, 1.0);
  // From scan 20 on the robot is in another place, 100 m off as far as points say: nothing fits
  // until the window starts again.
  TrackOptions options = lines();
  options.patience = 3, options.search_below.reset();
  for (std::size_t k = 20; k < 40; ++k)
    for (std::size_t n = 0; n < drive.scans[k].size(); ++n) {
      const Eigen::Vector2d p = Eigen::Rotation2Dd(drive.truth[k].yaw) *
                                Eigen::Vector2d(drive.scans[k].x[n], drive.scans[k].y[n]);
      const Eigen::Vector2d far =
          Eigen::Rotation2Dd(-drive.truth[k].yaw) * (1.7 * p + Eigen::Vector2d(100, 0));
      drive.scans[k].x[n] = static_cast<float>(far.x()),
      drive.scans[k].y[n] = static_cast<float>(far.y());
    }
  const Tracked tracked = drive.follow(options);
  EXPECT_EQ(tracked.restarts, 1u);
  EXPECT_EQ(tracked.unfit, 4u);
}

TEST(Track, AnEdgeThatIsNotSequentialStartsTheWindowAgain) {
  Drive drive;
  drive.chain.list[29].kind = EdgeKind::neighbour;
  const Tracked tracked = drive.follow(lines());
  EXPECT_EQ(tracked.restarts, 1u);
  EXPECT_LT(drive.error(tracked.poses, 59), 0.02);
}

TEST(Track, PutsScansOutsideTheChainBetweenTheirNeighbours) {
  Drive drive(12);
  drive.chain.list = {{1, 2}, {2, 5}, {5, 6}, {6, 7}};
  const Tracked tracked = drive.follow(lines());
  const auto& T = tracked.poses.T_world_segment;
  EXPECT_LT((T[3].translation - interpolate(T[2], T[5], 1. / 3).translation).norm(), 1e-12);
  EXPECT_LT((tracked.poses.relative(7, 11).translation - drive.odometry.relative(7, 11).translation)
                .norm(),
            1e-12);
  EXPECT_LT(
      (tracked.poses.relative(0, 1).translation - drive.odometry.relative(0, 1).translation).norm(),
      1e-12);
  drive.chain.list.clear();
  EXPECT_EQ(drive.follow(lines()).poses.T_world_segment[11].translation,
            drive.odometry.T_world_segment[11].translation);
}

/// A corridor without ends: two walls as far as the laser sees.
Cloud corridor_scan(const PlanarPose& at, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.005);
  Cloud cloud;
  for (int k = 0; k < 360; ++k) {
    const double angle = M_PI * (k + 0.5) / 180, heading = at.yaw + angle;
    const double range =
        ((std::sin(heading) > 0 ? 1 : -1) - at.y) / std::sin(heading) + noise(random);
    if (range < 8)
      cloud.add({static_cast<float>(range * std::cos(angle)),
                 static_cast<float>(range * std::sin(angle)), 0});
  }
  return cloud;
}

TEST(Track, StandsWhereTheOdometryStandsEvenBetweenBareWalls) {
  Drive drive(1);
  PlanarPose at;
  drive.truth = {at}, drive.scans = {corridor_scan(at, 1)},
  drive.odometry.T_world_segment = {in_space(at)};
  for (std::uint32_t k = 1; k < 80; ++k) {
    if (k < 30) at.x += 0.08;
    drive.truth.push_back(at), drive.scans.push_back(corridor_scan(at, k)),
        drive.odometry.T_world_segment.push_back(in_space(at));
    drive.chain.list.push_back({k - 1, k});
  }
  drive.chain.segments = 80;
  const Tracked tracked = drive.follow(lines());
  EXPECT_LT(drive.error(tracked.poses, 29), 0.1);
  EXPECT_LT((tracked.poses.relative(29, 79).translation).norm(), 0.1);
}

TEST(Track, GoesOnAsBeforeWhereAScanFitsNowhereAndThereIsNoOdometry) {
  Drive drive(40);
  drive.without_odometry();
  for (const std::size_t spoilt : {20, 21, 22})
    for (std::size_t k = 0; k < drive.scans[spoilt].size(); ++k)
      drive.scans[spoilt].x[k] = 40 + 0.2f * static_cast<float>(k), drive.scans[spoilt].y[k] = 0;
  const Tracked tracked = drive.follow(lines());
  EXPECT_EQ(tracked.unfit, 3u);
  for (const std::size_t k : {20, 22, 39}) EXPECT_LT(drive.error(tracked.poses, k), 0.08) << k;
}

TEST(Track, RefusesEdgesThatAreNoChain) {
  Drive drive(6);
  drive.chain.list = {{0, 1}, {3, 4}};
  EXPECT_THROW(drive.follow(lines()), Error);
  drive.chain.list = {{0, 1}, {1, 1}};
  EXPECT_THROW(drive.follow(lines()), Error);
}

TEST(Track, RefusesPosesOfOtherScans) {
  Drive drive(5);
  drive.odometry.T_world_segment.pop_back();
  EXPECT_THROW(drive.follow(lines()), Error);
}

TEST(TrackStep, GivesPosesAndWhatItCounted) {
  const Drive drive(20);
  std::vector<Segment> segments;
  for (const Cloud& scan : drive.scans)
    segments.push_back(Segment().with(scan, std::vector<std::uint16_t>(scan.size(), 0)));
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.each("segments", segments)
      .with("poses", drive.odometry)
      .with("edges", drive.chain)
      .set("odometry_sigma", 0.05);
  EXPECT_LT(drive.error(step.run<Poses>("poses", context), 19), 0.02);
  EXPECT_GE(context.counts["iterations"], 19u);
  EXPECT_EQ(step.run<Metrics>("metrics", context).numbers[0].value, 19);
  step.set("metric", std::string("point"));
  EXPECT_THROW(step.run<Poses>("poses", context), Error);  // 'odometry_sigma' goes with lines
}

}  // namespace
}  // namespace plumb::track_sliding_window
