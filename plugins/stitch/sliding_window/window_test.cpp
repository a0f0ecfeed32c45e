#include "window.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::stitch_sliding_window {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::uint32_t> window(const Windows& windows, std::size_t k) {
  return {windows.members.begin() + windows.first[k], windows.members.begin() + windows.end[k]};
}

Edges chain(std::uint32_t segments, std::vector<Edge> list) { return {segments, std::move(list)}; }

TEST(SlidingWindow, HoldsTheNewestAndThoseBefore) {
  const auto windows = sliding_windows(6, nullptr, 3, 0);
  EXPECT_THAT(window(windows, 0), ElementsAre(0));
  EXPECT_THAT(window(windows, 1), ElementsAre(0, 1));
  EXPECT_THAT(window(windows, 5), ElementsAre(3, 4, 5));
}

TEST(SlidingWindow, TakesFollowingScansWhenToldTo) {
  const auto windows = sliding_windows(6, nullptr, 2, 2);
  EXPECT_THAT(window(windows, 2), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(window(windows, 5), ElementsAre(4, 5));
}

TEST(SlidingWindow, LeavesOutDroppedScansAndReachesOverThem) {
  const Edges edges = chain(5, {{0, 1}, {1, 3}, {3, 4}});
  const auto windows = sliding_windows(5, &edges, 3, 1);
  EXPECT_THAT(window(windows, 3), ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(window(windows, 2),
              ElementsAre(0, 1, 3));  // a dropped one has the window of the accepted one before it
}

TEST(SlidingWindow, DoesNotReachOverWhereItStartedAgain) {
  const Edges edges = chain(6, {{0, 1}, {1, 2}, {2, 4, EdgeKind::neighbour}, {4, 5}});
  const auto windows = sliding_windows(6, &edges, 4, 3);
  EXPECT_THAT(window(windows, 1), ElementsAre(0, 1, 2));
  EXPECT_THAT(window(windows, 4), ElementsAre(4, 5));
  EXPECT_THAT(window(windows, 5), ElementsAre(4, 5));
}

TEST(SlidingWindow, IsEmptyUntilItIsFullWhenToldTo) {
  const Edges edges = chain(6, {{0, 1}, {1, 2}, {2, 4, EdgeKind::neighbour}, {4, 5}});
  auto windows = sliding_windows(6, &edges, 2, 0);
  empty_short_ones(windows, 2);
  EXPECT_THAT(window(windows, 0), IsEmpty());
  EXPECT_THAT(window(windows, 1), ElementsAre(0, 1));
  EXPECT_THAT(window(windows, 2), ElementsAre(1, 2));
  EXPECT_THAT(window(windows, 4), IsEmpty());  // it has started again
  EXPECT_THAT(window(windows, 5), ElementsAre(4, 5));
}

TEST(SlidingWindow, IsEmptyBeforeTheFirstAcceptedScan) {
  const Edges edges = chain(3, {{1, 2}});
  EXPECT_THAT(window(sliding_windows(3, &edges, 4, 0), 0), IsEmpty());
  EXPECT_THAT(sliding_windows(0, nullptr, 4, 0).members, IsEmpty());
}

/// Scans of one corner point at (7, 3) of the world, seen from different poses; each with a point
/// of its own.
struct Drive {
  Poses poses;
  std::vector<Segment> scans;
  Drive() {
    for (int k = 0; k < 5; ++k) {
      const Pose T(exp_rotation({0, 0, 0.4 * k}), {0.5 * k, -0.2 * k, 0});
      poses.T_world_segment.push_back(T);
      Cloud cloud;
      cloud.add((T.inverse() * Eigen::Vector3d(7, 3, 0)).cast<float>());
      cloud.add({static_cast<float>(k), 40, 0});
      Segment scan;
      scan.range.first = static_cast<std::uint32_t>(k), scan.range.end = scan.range.first + 1;
      scan.range.T_segment_frame.resize(1);
      scans.push_back(scan.with(cloud, {0, 0}));
    }
  }
};

std::vector<Segment> groups_of(const Drive& drive, ParameterValue voxel_size,
                               bool full_only = false) {
  const Step& step = *plumb_module()->steps[0];
  std::vector<PortInput> inputs(3);
  inputs[0].wired = inputs[1].wired = true;
  inputs[0].each = [&] {
    struct Held : Collection {
      std::vector<AnyValue> items;
      std::size_t size() const override { return items.size(); }
      AnyValue open(std::size_t k) const override { return items[k]; }
    };
    auto held = std::make_shared<Held>();
    for (const auto& scan : drive.scans) held->items.push_back(any_value(scan));
    return held;
  }();
  inputs[1].one = any_value(drive.poses);
  std::vector<PortOutput> outputs(1);
  TestContext context;
  const ParameterValues values{
      {"frames", std::int64_t{3}}, {"voxel_size", voxel_size}, {"full_only", full_only}};
  step.run(step.parameters(values).get(), inputs, outputs, context);
  std::vector<Segment> submaps;
  for (const auto& value : outputs[0].many) submaps.push_back(*value.as<Segment>());
  return submaps;
}

TEST(SlidingWindow, StitchesInTheNewestScansCoordinates) {
  const Drive drive;
  const auto submaps = groups_of(drive, std::monostate{});
  ASSERT_EQ(submaps.size(), 5u);
  ASSERT_EQ(submaps[4].cloud.size(), 6u);
  const Eigen::Vector3f corner = drive.scans[4].cloud.point(0);
  for (const int n : {0, 2, 4}) EXPECT_LT((submaps[4].cloud.point(n) - corner).norm(), 1e-5f);
  EXPECT_EQ(submaps[4].cloud.point(5), drive.scans[4].cloud.point(1));
  EXPECT_EQ(submaps[4].range.first, 4u);
  EXPECT_EQ(submaps[4].frame, std::vector<std::uint16_t>(6, 0));
  EXPECT_LT((submaps[4].centroid - centroid_of(submaps[4].cloud)).norm(), 1e-6f);
  EXPECT_EQ(submaps[4].box.high, box_of(submaps[4].cloud).high);
  for (const auto& group : submaps)
    for (const float z : group.cloud.z) EXPECT_EQ(z, 0);  // planar stays planar
}

TEST(SlidingWindow, GivesNoSubmapOfAWindowThatIsNotFullWhenToldTo) {
  const auto submaps = groups_of(Drive(), std::monostate{}, true);
  ASSERT_EQ(submaps.size(), 5u);
  for (const int k : {0, 1}) EXPECT_TRUE(submaps[k].cloud.empty()) << k;
  for (const int k : {2, 3, 4}) EXPECT_EQ(submaps[k].cloud.size(), 6u) << k;
}

TEST(SlidingWindow, ThinsToOnePointACell) {
  const auto submaps = groups_of(Drive(), 0.5);
  EXPECT_EQ(submaps[4].cloud.size(),
            4u);  // the corner, seen three times, and three points of their own
  EXPECT_LT((submaps[4].cloud.point(0) - Drive().scans[4].cloud.point(0)).norm(), 1e-5f);
}

TEST(SlidingWindow, RefusesPosesOfOtherSegments) {
  Drive drive;
  drive.poses.T_world_segment.pop_back();
  EXPECT_THROW(groups_of(drive, std::monostate{}), Error);
}

}  // namespace
}  // namespace plumb::stitch_sliding_window
