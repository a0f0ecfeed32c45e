#include "loops.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "poles_testing.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::loops_scan_context {
namespace {

/// Segments seen from `truth`, and poses that the odometry has instead.
StepUnderTest step_for(const Cloud& world, const std::vector<Pose>& truth, const Pose& drift) {
  std::vector<Segment> segments;
  Poses poses;
  Pose drifted;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    segments.push_back(seen_from(world, truth[k]));
    if (k > 0) drifted = drifted * (truth[k - 1].inverse() * truth[k]) * drift;
    poses.T_world_segment.push_back(drifted);
  }
  StepUnderTest step(*plumb_module());
  step.each("segments", segments).with("poses", poses).set("max_range", 40.0);
  return step;
}
const Pose no_drift{};
/// 2 m and 2 degrees from segment to segment: 80 degrees in the end.
const Pose heavy_drift(exp_rotation({0, 0, 2 * deg}), {1.5, 1.3, 0.1});

std::size_t of_one_place(const Edges& edges) {
  return static_cast<std::size_t>(std::ranges::count_if(
      edges.list, [&](const Edge& e) { return e.i + e.j + 1 == edges.segments; }));
}

TEST(ScanContextLoops, PairTheWayBackWithTheWayOutHoweverTheOdometryDrifts) {
  const Cloud world = poles(1);
  for (const Pose& drift : {no_drift, heavy_drift}) {
    TestContext context;
    const auto edges = step_for(world, out_and_back(20), drift).run<Edges>("edges", context);
    EXPECT_GE(of_one_place(edges), 15u);
    EXPECT_LE(edges.size() - of_one_place(edges), 3u);
    EXPECT_EQ(context.counts["loop edges"], edges.size());
    EXPECT_TRUE(context.warnings.empty());
    for (std::size_t k = 0; k < edges.size(); ++k) {
      EXPECT_EQ(edges.list[k].kind, EdgeKind::loop);
      EXPECT_LT(edges.list[k].i, edges.list[k].j);
      if (k > 0) {
        EXPECT_LT(std::pair(edges.list[k - 1].i, edges.list[k - 1].j),
                  std::pair(edges.list[k].i, edges.list[k].j));
      }
    }
  }
}

TEST(ScanContextLoops, AreHardlyMadeUpOnAWayWithoutReturn) {
  auto way = out_and_back(20);
  way.resize(20);
  TestContext context;
  EXPECT_LE(step_for(poles(1), way, no_drift).run<Edges>("edges", context).size(), 2u);
}

TEST(ScanContextLoops, FollowAGivenThresholdAndSayWhenThereIsNone) {
  TestContext context;
  StepUnderTest step = step_for(poles(1), out_and_back(20), no_drift);
  EXPECT_EQ(step.set("threshold", 1.0).run<Edges>("edges", context).size(), 0u);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_THAT(context.warnings[0], testing::HasSubstr("no loop found"));
  const auto all = step.set("threshold", 0.0).run<Edges>("edges", context);
  EXPECT_GE(all.size(), 20u);
  for (const Edge& e : all.list) EXPECT_GE(e.j - e.i, 4u) << "40 m, four steps";
}

TEST(ScanContextLoops, StayWithinTheDriftThatIsExpected) {
  TestContext context;
  StepUnderTest step = step_for(poles(1), out_and_back(20), heavy_drift);
  const auto everywhere = step.run<Edges>("edges", context),
             near = step.set("drift", 0.01).run<Edges>("edges", context);
  EXPECT_LT(near.size(), everywhere.size());
  for (const Edge& e : near.list) EXPECT_LT(e.centroid_distance, 2 * 13 + 0.01 * 500);
}

TEST(ScanContextLoops, GiveASegmentNoMorePartnersThanAsked) {
  std::vector<Pose> laps;  // five times the same way
  for (int lap = 0; lap < 5; ++lap)
    for (int k = 0; k < 12; ++k) laps.push_back(standing(10 * k, 0.2 * lap, 0));
  TestContext context;
  StepUnderTest step = step_for(poles(6), laps, no_drift);
  for (const std::int64_t each : {1, 3}) {
    const auto edges = step.set("loops_per_segment", each).run<Edges>("edges", context);
    EXPECT_LE(edges.size(), static_cast<std::size_t>(60 * each));
    EXPECT_GE(edges.size(), static_cast<std::size_t>(25 * each));
  }
}

TEST(ScanContextLoops, AreTheSameForAnyOrderOfTheWork) {
  const StepUnderTest step = step_for(poles(1), out_and_back(12), no_drift);
  TestContext forwards;
  parallel::ThreadedContext together;
  const auto a = step.run<Edges>("edges", forwards), b = step.run<Edges>("edges", together);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a.list[k].i, b.list[k].i);
    EXPECT_EQ(a.list[k].j, b.list[k].j);
    EXPECT_EQ(a.list[k].score, b.list[k].score);
  }
}

TEST(ScanContextLoops, OfNoAndOfFewSegmentsAreNone) {
  for (const int count : {0, 1, 2}) {
    auto way = out_and_back(3);
    way.resize(static_cast<std::size_t>(count));
    TestContext context;
    EXPECT_EQ(step_for(poles(1), way, no_drift).run<Edges>("edges", context).size(), 0u);
  }
}

TEST(ScanContextLoops, RefusePosesOfOtherSegments) {
  TestContext context;
  StepUnderTest step = step_for(poles(1), out_and_back(3), no_drift);
  step.with("poses", Poses());
  EXPECT_THROW(step.run<Edges>("edges", context), Error);
}

}  // namespace
}  // namespace plumb::loops_scan_context
