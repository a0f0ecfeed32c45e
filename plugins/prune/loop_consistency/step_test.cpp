/// The step as the engine sees it: which loops it gives on, and what it says of the others.
#include "plumb/slam/step.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/values.hpp"
#include "two_laps_testing.hpp"

namespace plumb::prune_loop_consistency {
namespace {

struct Registered {
  std::vector<Registration> registrations;
  Edges edges;
};

Registered registered(const std::vector<Loop>& loops, std::uint32_t segments) {
  Registered all;
  all.edges.segments = segments;
  for (const auto& loop : loops) {
    all.edges.list.push_back({loop.i, loop.j, EdgeKind::loop, 0.8f, 1});
    Registration r;
    r.T_i_j = loop.T_i_j;
    r.information.diagonal() << 100, 400, 900, 1e4, 4e4, 9e4;
    r.pairs = 500;
    r.accepted = true;
    all.registrations.push_back(r);
  }
  return all;
}

StepUnderTest pruning(const Registered& all, const Poses& poses) {
  StepUnderTest step(*plumb_module());
  step.each("registrations", all.registrations, all.edges).with("poses", poses);
  return step;
}

double number(const Metrics& metrics, const std::string& name) {
  const auto found = std::ranges::find(metrics.numbers, name, &Number::name);
  EXPECT_NE(found, metrics.numbers.end()) << name;
  return found == metrics.numbers.end() ? -1 : found->value;
}

TEST(PruneLoopConsistency, GivesTheKeptLoopsAndAReasonForEach) {
  const Drive drive = two_laps(1);
  auto loops = right_loops(drive, 1);
  loops[3].T_i_j.translation += Eigen::Vector3d(80, 0, 0);
  loops[11].T_i_j.translation += Eigen::Vector3d(0, 20, 0);
  auto all = registered(loops, 96);
  all.registrations[17].accepted = false;
  TestContext context;
  const auto constraints = pruning(all, drive.drifted).run<Constraints>("constraints", context);
  EXPECT_EQ(context.counts["loops kept"], loops.size() - 3);
  EXPECT_EQ(context.counts["loops dropped: explained by no drift"], 1u);
  EXPECT_EQ(context.counts["loops dropped: contradicted by other loops"], 1u);
  EXPECT_EQ(context.counts["loops dropped: alone and far"], 0u);
  ASSERT_EQ(constraints.relative.size(), loops.size() - 3);
  EXPECT_FALSE(constraints.planar);
  std::size_t at = 0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (k == 3 || k == 11 || k == 17) continue;
    EXPECT_EQ(constraints.relative[at].i, loops[k].i);
    EXPECT_EQ(constraints.relative[at].j, loops[k].j);
    EXPECT_EQ(constraints.relative[at].T_i_j.translation, loops[k].T_i_j.translation);
    ++at;
  }
  const auto metrics = pruning(all, drive.drifted).run<Metrics>("metrics", context);
  EXPECT_EQ(metrics.numbers.front().name, "loops_kept");
  EXPECT_EQ(number(metrics, "loops_kept"), static_cast<double>(loops.size() - 3));
  EXPECT_EQ(number(metrics, "loops_asked"), static_cast<double>(loops.size()));
  EXPECT_EQ(number(metrics, "loops_registered"), static_cast<double>(loops.size() - 1));
  EXPECT_EQ(number(metrics, "loops_against_odometry"), 1);
  EXPECT_EQ(number(metrics, "loops_against_loops"), 1);
  EXPECT_EQ(number(metrics, "loops_alone"), 0);
  ASSERT_EQ(metrics.edges.size(), loops.size());
  EXPECT_EQ(metrics.edges[0].status, "accepted");
  EXPECT_EQ(metrics.edges[0].kept, 500u);
  EXPECT_EQ(metrics.edges[3].status, "rejected: no drift explains it");
  EXPECT_EQ(metrics.edges[11].status, "rejected: other loops of the place contradict it");
  EXPECT_EQ(metrics.edges[11].kept, 0u);
  EXPECT_EQ(metrics.edges[17].status, "not registered");
  // What is left between a kept loop and the poses is the drift.
  const Loop& last = loops.back();
  const double drift =
      (last.T_i_j.inverse() * drive.drifted.relative(last.i, last.j)).translation.norm();
  EXPECT_NEAR(metrics.edges.back().residual, drift, 1e-12);
}

TEST(PruneLoopConsistency, AddsItsOwnDeviationsToThoseOfTheRegistration) {
  const Drive drive = two_laps(1);
  auto all = registered(right_loops(drive, 1), 96);
  TestContext context;
  auto step = pruning(all, drive.drifted);
  step.set("translation_sigma", 0.2).set("rotation_sigma", 0.01);
  const auto constraints = step.run<Constraints>("constraints", context);
  ASSERT_FALSE(constraints.relative.empty());
  const Matrix6d& information = constraints.relative[0].information;
  const Vector6d before = all.registrations[0].information.diagonal();
  for (int a = 0; a < 6; ++a) {
    const double sigma = a < 3 ? 0.2 : 0.01, expected = 1 / (1 / before[a] + sigma * sigma);
    EXPECT_NEAR(information(a, a), (a < 3 ? 1 : 4) * expected, 1e-9 * expected)
        << a;  // by q.vec, half the angle
  }
  EXPECT_LT((information - Matrix6d(information.diagonal().asDiagonal())).norm(),
            1e-9 * information.norm());
}

TEST(PruneLoopConsistency, LeavesUnknownWhatTheRegistrationDoesNotKnow) {
  const Drive drive = two_laps(1);
  auto all = registered(right_loops(drive, 1), 96);
  for (auto& r : all.registrations) r.information(0, 0) = 0;  // along a corridor
  all.registrations[0].information.setZero();
  TestContext context;
  const auto constraints = pruning(all, drive.drifted).run<Constraints>("constraints", context);
  ASSERT_EQ(constraints.relative.size(), all.registrations.size());
  EXPECT_TRUE(constraints.relative[0].information.isZero(0));
  for (std::size_t k = 1; k < constraints.relative.size(); ++k) {
    EXPECT_LT(constraints.relative[k].information(0, 0), 1e-3);
    EXPECT_GT(constraints.relative[k].information(1, 1), 10);
  }
}

TEST(PruneLoopConsistency, KeepsNothingOfNoLoops) {
  TestContext context;
  EXPECT_TRUE(pruning(registered({}, 96), two_laps(1).drifted)
                  .run<Constraints>("constraints", context)
                  .relative.empty());
  EXPECT_EQ(context.counts["loops kept"], 0u);
}

TEST(PruneLoopConsistency, MultipliesItsLengthsByTheScale) {
  // A walk through rooms, a tenth as large, is judged as the drive.
  const Drive drive = two_laps(8);
  auto loops = right_loops(drive, 8);
  loops[11].T_i_j.translation += Eigen::Vector3d(0, 20, 0);
  Poses small = drive.drifted;
  for (auto& T : small.T_world_segment) T.translation *= 0.1;
  for (auto& loop : loops) loop.T_i_j.translation *= 0.1;
  TestContext context;
  const auto metrics = pruning(registered(loops, 96), small)
                           .with("scale", Metrics().add("scale", 0.1, ""))
                           .run<Metrics>("metrics", context);
  EXPECT_EQ(metrics.edges[11].status, "rejected: other loops of the place contradict it");
  EXPECT_EQ(number(metrics, "loops_kept"), static_cast<double>(loops.size() - 1));
}

TEST(PruneLoopConsistency, RefusesPosesOfOtherSegments) {
  Poses few = two_laps(1).drifted;
  few.T_world_segment.resize(40);
  TestContext context;
  const auto step = pruning(registered(right_loops(two_laps(1), 1), 96), few);
  EXPECT_EQ(io::refusal([&] { step.run<Constraints>("constraints", context); }),
            "a loop names segment 48, but got 40 poses: wire poses of the same segments");
}

}  // namespace
}  // namespace plumb::prune_loop_consistency
