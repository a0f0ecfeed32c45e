#include "gate.hpp"

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::gate_distance {
namespace {

/// Scans of 100 points at these ranges; a negative one is empty.
std::vector<Seen> scans_at(const std::vector<double>& ranges) {
  std::vector<Seen> scans;
  for (const double r : ranges) scans.push_back({std::max(r, 0.0), r < 0 ? 0u : 100u});
  return scans;
}

std::string text(const Edges& edges) {
  std::string all;
  for (const auto& e : edges.list)
    all += (all.empty() ? "" : " ") + std::to_string(e.i) + "-" + std::to_string(e.j) +
           (e.kind == EdgeKind::neighbour ? "!" : "");
  return all;
}

TEST(GateDistance, MeasuresChangeWithoutUnit) {
  EXPECT_DOUBLE_EQ(change_of(3, 1), 0.25);
  EXPECT_DOUBLE_EQ(change_of(1, 3), change_of(300, 100));
  EXPECT_EQ(change_of(0, 0), 0);
  EXPECT_EQ(change_of(0, 2), 1);
}

TEST(GateDistance, JoinsEachScanToTheOneBefore) {
  EXPECT_EQ(text(gated_chain(scans_at({2, 2.1, 2.2, 2.1}), {}).edges), "0-1 1-2 2-3");
}

TEST(GateDistance, LeavesOutAScanThatJumpsAndJoinsRoundIt) {
  const auto gated = gated_chain(scans_at({2, 2, 9, 2, 2}), {});
  EXPECT_EQ(text(gated.edges), "0-1 1-3 3-4");
  EXPECT_EQ(gated.accepted, 4u);
  EXPECT_EQ(gated.far, 1u);
  EXPECT_EQ(gated.resets, 0u);
}

TEST(GateDistance, StartsAgainWhenPatienceIsUsedUp) {
  GateOptions options;
  options.patience = 3;
  const auto gated = gated_chain(scans_at({2, 2, 9, 9, 9, 9, 9}), options);
  EXPECT_EQ(text(gated.edges), "0-1 1-5! 5-6");
  EXPECT_EQ(gated.far, 3u);
  EXPECT_EQ(gated.resets, 1u);
  options.patience = 0;
  EXPECT_EQ(text(gated_chain(scans_at({2, 9, 9}), options).edges), "0-1! 1-2");
}

TEST(GateDistance, DropsEmptyScansWithoutLosingPatience) {
  const auto gated = gated_chain(scans_at({-1, 2, -1, -1, -1, -1, -1, -1, -1, 9, 2}), {});
  EXPECT_EQ(text(gated.edges), "1-10");
  EXPECT_EQ(gated.empty, 8u);
  EXPECT_EQ(gated.far, 1u);
  EXPECT_EQ(gated.resets, 0u);
}

/// Scans of 100 points at 2 m, with these stamps [s].
std::vector<Seen> scans_when(const std::vector<double>& stamps) {
  std::vector<Seen> scans;
  for (const double t : stamps) scans.push_back({2, 100, t, t});
  return scans;
}

TEST(GateDistance, StartsAgainAfterAStretchWithoutScans) {
  GateOptions options;
  options.max_time_gap = 3;
  auto scans = scans_when({0, 0.2, 0.4, 4.4, 4.6, 4.8});
  auto gated = gated_chain(scans, options);
  EXPECT_EQ(text(gated.edges), "0-1 1-2 2-3! 3-4 4-5");
  EXPECT_EQ(gated.resets, 1u);
  EXPECT_EQ(gated.gaps, 1u);
  scans[3].points = 0;  // the first scan after it is of no use: the next one starts
  EXPECT_EQ(text(gated_chain(scans, options).edges), "0-1 1-2 2-4! 4-5");
  options.max_time_gap = std::nullopt;
  EXPECT_EQ(gated_chain(scans, options).resets, 0u);
}

TEST(GateDistance, TakesNoGapFromSlowLogsOrStampsThatStepBack) {
  GateOptions options;
  options.max_time_gap = 3;
  EXPECT_EQ(gated_chain(scans_when({0, 4, 8, 12, 16, 30}), options).resets,
            0u);  // 14 s are but 3.5 usual stretches
  EXPECT_EQ(gated_chain(scans_when({0, 0.2, 0.4, -90, -89.8, 0.6, 0.8}), options).gaps, 1u);
}

TEST(GateDistance, CountsEveryScanOnce) {
  Random random(3);
  for (int turn = 0; turn < 50; ++turn) {
    std::vector<double> ranges;
    for (int k = 0; k < 60; ++k)
      ranges.push_back(random.uniform() < 0.1 ? -1 : 1 + 4 * random.uniform());
    const auto gated = gated_chain(scans_at(ranges), {0.1, 2, 10});
    EXPECT_EQ(gated.accepted + gated.far + gated.empty, ranges.size());
    ASSERT_EQ(gated.edges.size(), gated.accepted - 1);
    for (std::size_t k = 1; k < gated.edges.size(); ++k)
      EXPECT_EQ(gated.edges.list[k].i, gated.edges.list[k - 1].j);
  }
}

TEST(GateDistance, TakesTheRangeOfTheCloudsOwnCentre) {
  std::vector<Segment> segments;
  for (const float x : {2.f, 2.1f, 9.f, 2.2f}) {
    Cloud cloud;
    for (int k = 0; k < 20; ++k) cloud.add({x, 0.1f * static_cast<float>(k - 10), 0});
    segments.push_back(Segment().with(cloud, std::vector<std::uint16_t>(20, 0)));
  }
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.each("segments", segments);
  EXPECT_EQ(text(step.run<Edges>("edges", context)), "0-1 1-3");
  EXPECT_EQ(context.counts["scans dropped for a jump"], 1u);
  EXPECT_EQ(step.run<Metrics>("metrics", context).numbers[1].value, 1);
}

TEST(GateDistance, TakesStampsFromTheTrajectory) {
  std::vector<Segment> segments(8);
  Trajectory trajectory;
  for (std::uint32_t k = 0; k < 16; ++k) trajectory.stamps.push_back(0.2 * k + (k < 10 ? 0 : 60));
  trajectory.T_world_frame.resize(16);
  for (std::uint32_t k = 0; k < 8; ++k) {
    Cloud cloud;
    for (int n = 0; n < 20; ++n) cloud.add({2, 0.1f * static_cast<float>(n - 10), 0});
    segments[k] = Segment().with(cloud, std::vector<std::uint16_t>(20, 0));
    segments[k].range.first = 2 * k, segments[k].range.end = 2 * k + 2;
  }
  TestContext context;
  EXPECT_EQ(text(StepUnderTest(*plumb_module())
                     .each("segments", segments)
                     .with("trajectory", trajectory)
                     .run<Edges>("edges", context)),
            "0-1 1-2 2-3 3-4 4-5! 5-6 6-7");
  trajectory.stamps.resize(15), trajectory.T_world_frame.resize(15);
  StepUnderTest other(*plumb_module());
  other.each("segments", segments).with("trajectory", trajectory);
  EXPECT_THROW(other.run<Edges>("edges", context), Error);
}

TEST(GateDistance, SaysThatThereIsNoChain) {
  TestContext context;
  StepUnderTest(*plumb_module())
      .each("segments", std::vector<Segment>(3))
      .run<Edges>("edges", context);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_EQ(context.warnings[0], "fewer than two scans of 3 are accepted: there is no chain");
}

}  // namespace
}  // namespace plumb::gate_distance
