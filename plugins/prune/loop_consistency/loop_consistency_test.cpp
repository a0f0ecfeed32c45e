#include "loop_consistency.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/registration.hpp"
#include "plumb/slam/step.hpp"
#include "plumb/slam/values.hpp"

namespace plumb::prune_loop_consistency {
namespace {

Eigen::Vector3d gauss3(std::mt19937& random, double sigma) {
  std::normal_distribution<double> g(0, sigma);
  const double x = g(random), y = g(random), z = g(random);
  return {x, y, z};
}

// ---- what the poses can have drifted
// ----------------------------------------------------------------------------------------

TEST(DriftModel, GrowsWithThePathWithinItsMemoryAndWithTheRootBeyond) {
  const DriftModel drift{0.01, 0.001, 100};
  EXPECT_DOUBLE_EQ(drift.rotation(50), 0.05);
  EXPECT_DOUBLE_EQ(drift.rotation(100), 0.1);
  EXPECT_DOUBLE_EQ(drift.rotation(400), 0.2);
  EXPECT_DOUBLE_EQ(drift.position(50, 0), 0.5);
  EXPECT_DOUBLE_EQ(drift.position(400, 0), 2);
  EXPECT_DOUBLE_EQ(drift.position(0, 1000), 0);
}

/// The judge walks straight on: the errors of the heading and of the length stay the same for 100
/// m, then others come.
TEST(DriftModel, IsTheDeviationOfWalksWhoseErrorsLastForTheMemory) {
  const DriftModel drift{0.01, 0.0005, 100};
  std::mt19937 random(1);
  constexpr int walks = 3000, length = 1000;
  double headings = 0, places = 0;
  for (int n = 0; n < walks; ++n) {
    double turn = 0, stretch = 0, heading = 0, along = 0, across = 0;
    for (int metre = 0; metre < length; ++metre) {
      if (metre % 100 == 0) {
        turn = gauss3(random, drift.rotation_per_metre).x();
        stretch = gauss3(random, drift.translation_per_metre).x();
      }
      heading += turn;
      along += stretch;
      across += heading;
    }
    headings += heading * heading / walks;
    places += (along * along + across * across) / walks;
  }
  EXPECT_NEAR(std::sqrt(headings), drift.rotation(length), 0.05 * drift.rotation(length));
  EXPECT_NEAR(std::sqrt(places), drift.position(length, length),
              0.05 * drift.position(length, length));
}

// ---- which loops are kept
// ---------------------------------------------------------------------------------------------------

/// Two laps round a square of 4 x 12 segments, 10 m apart, with drift as a car's odometry has it.
struct Drive {
  Poses truth, drifted;
  static constexpr std::uint32_t lap = 48;
};

Drive two_laps(std::uint32_t seed, double drift = 1) {
  std::mt19937 random(seed);
  Drive drive;
  const Pose ahead(Eigen::Quaterniond::Identity(), {10, 0, 0}),
      corner(exp_rotation({0, 0, M_PI / 2}), {10, 0, 0});
  drive.truth.T_world_segment.resize(1);
  drive.drifted.T_world_segment.resize(1);
  const Eigen::Vector3d slow = gauss3(random, 0.0002 * drift);  // [rad/m], the same all the way
  for (std::uint32_t k = 1; k < 2 * Drive::lap; ++k) {
    const Pose& motion = k % 12 == 0 ? corner : ahead;
    const Pose error(exp_rotation(10 * slow + gauss3(random, 0.001 * drift)),
                     gauss3(random, 0.03 * drift));
    drive.truth.T_world_segment.push_back(drive.truth.T_world_segment.back() * motion);
    drive.drifted.T_world_segment.push_back(drive.drifted.T_world_segment.back() * motion * error);
  }
  return drive;
}

/// The loop that a registration of i and j gives where all is well.
Loop right_loop(const Drive& drive, std::uint32_t i, std::uint32_t j, std::mt19937& random) {
  return {
      i, j,
      drive.truth.relative(i, j) * Pose(exp_rotation(gauss3(random, 0.001)), gauss3(random, 0.03))};
}

/// From every second segment of the first lap to the second one.
std::vector<Loop> right_loops(const Drive& drive, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Loop> loops;
  for (std::uint32_t k = 0; k < Drive::lap; k += 2)
    loops.push_back(right_loop(drive, k, k + Drive::lap, random));
  return loops;
}

std::size_t count(const std::vector<LoopVerdict>& verdicts, LoopVerdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(verdicts, verdict));
}

TEST(LoopConsistency, KeepsAllLoopsThatAreRight) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const Drive drive = two_laps(seed);
    const auto verdicts = judge_loops(right_loops(drive, seed), drive.drifted, {});
    EXPECT_EQ(count(verdicts, LoopVerdict::kept), verdicts.size()) << seed;
  }
}

TEST(LoopConsistency, DropsWhatNoDriftExplains) {
  const Drive drive = two_laps(1);
  auto loops = right_loops(drive, 1);
  loops[5].T_i_j.translation += Eigen::Vector3d(80, 0, 0);
  loops[9].T_i_j.rotation = loops[9].T_i_j.rotation * exp_rotation({0, 0, M_PI});
  const auto verdicts = judge_loops(loops, drive.drifted, {});
  EXPECT_EQ(verdicts[5], LoopVerdict::against_odometry);
  EXPECT_EQ(verdicts[9], LoopVerdict::against_odometry);
  EXPECT_EQ(count(verdicts, LoopVerdict::kept), loops.size() - 2);
}

TEST(LoopConsistency, DropsLoopsWithinTheDriftThatTheirNeighboursContradict) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const Drive drive = two_laps(seed, 0.3);
    auto loops = right_loops(drive, seed);
    std::mt19937 random(seed);
    std::vector<std::size_t> wrong;
    for (std::size_t k = 1; k < loops.size();
         k += 4) {  // a quarter, each wrong in a way of its own
      loops[k].T_i_j.translation += 20 * gauss3(random, 1).normalized();
      wrong.push_back(k);
    }
    const auto verdicts = judge_loops(loops, drive.drifted, {});
    for (const auto k : wrong)
      EXPECT_EQ(verdicts[k], LoopVerdict::against_loops) << "seed " << seed << ", loop " << k;
    EXPECT_EQ(count(verdicts, LoopVerdict::kept), loops.size() - wrong.size()) << seed;
  }
}

TEST(LoopConsistency, DropsALoopThatIsWrongByItsAngleAlone) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const Drive drive = two_laps(seed, 0.3);
    auto loops = right_loops(drive, seed);
    loops[11].T_i_j.rotation = loops[11].T_i_j.rotation * exp_rotation({0, 0, 0.3});
    const auto verdicts = judge_loops(loops, drive.drifted, {});
    EXPECT_EQ(verdicts[11], LoopVerdict::against_loops) << seed;
    EXPECT_EQ(count(verdicts, LoopVerdict::kept), loops.size() - 1) << seed;
  }
}

TEST(LoopConsistency, DropsALoneLoopWhereTheDriftMayBeLarge) {
  const Drive drive = two_laps(3);
  std::mt19937 random(3);
  const std::vector<Loop> one{right_loop(drive, 4, 4 + Drive::lap, random)};
  ConsistencyOptions options;
  EXPECT_THAT(judge_loops(one, drive.drifted, options), testing::ElementsAre(LoopVerdict::alone));
  options.max_unconfirmed_sigma = 50;
  EXPECT_THAT(judge_loops(one, drive.drifted, options), testing::ElementsAre(LoopVerdict::kept));
}

TEST(LoopConsistency, KeepsALoneLoopOverAShortWay) {
  const Drive drive = two_laps(3);
  std::mt19937 random(3);
  EXPECT_THAT(judge_loops({right_loop(drive, 4, 10, random)}, drive.drifted, {}),
              testing::ElementsAre(LoopVerdict::kept));
}

TEST(LoopConsistency, KeepsTwoLoopsThatConfirmEachOther) {
  const Drive drive = two_laps(4);
  std::mt19937 random(4);
  EXPECT_THAT(judge_loops({right_loop(drive, 4, 52, random), right_loop(drive, 6, 54, random)},
                          drive.drifted, {}),
              testing::ElementsAre(LoopVerdict::kept, LoopVerdict::kept));
}

TEST(LoopConsistency, KeepsNeitherOfTwoFarLoopsThatContradictEachOther) {
  const Drive drive = two_laps(4);
  std::mt19937 random(4);
  std::vector<Loop> loops{right_loop(drive, 4, 52, random), right_loop(drive, 6, 54, random)};
  loops[1].T_i_j.translation += Eigen::Vector3d(0, 8, 0);
  EXPECT_EQ(count(judge_loops(loops, drive.drifted, {}), LoopVerdict::kept), 0u);
}

TEST(LoopConsistency, LetsLoopsOfOtherPlacesSayNothing) {
  const Drive drive = two_laps(5);
  std::mt19937 random(5);
  std::vector<Loop> loops;
  for (std::uint32_t k = 0; k < 4; ++k)
    loops.push_back(right_loop(drive, k, k + Drive::lap, random));
  ConsistencyOptions options;
  options.max_path_separation = 60;
  const auto before = judge_loops(loops, drive.drifted, options);
  Loop wrong = right_loop(drive, 30, 30 + Drive::lap, random);
  wrong.T_i_j.translation += Eigen::Vector3d(0, 5, 0);
  loops.push_back(wrong);
  auto after = judge_loops(loops, drive.drifted, options);
  EXPECT_EQ(after.back(), LoopVerdict::alone);
  after.pop_back();
  EXPECT_EQ(after, before);
}

TEST(LoopConsistency, DoesNotDependOnWhereTheWorldIsNorOnTheOrderOfLoops) {
  const Drive drive = two_laps(6);
  auto loops = right_loops(drive, 6);
  std::mt19937 random(6);
  for (std::size_t k = 2; k < loops.size(); k += 5)
    loops[k].T_i_j.translation += 20 * gauss3(random, 1).normalized();
  const auto verdicts = judge_loops(loops, drive.drifted, {});

  Poses elsewhere;
  const Pose far(exp_rotation({0.3, 0.2, 2}), {5000, -3000, 100});
  for (const auto& T : drive.drifted.T_world_segment) elsewhere.T_world_segment.push_back(far * T);
  EXPECT_EQ(judge_loops(loops, elsewhere, {}), verdicts);

  std::vector<std::size_t> order(loops.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::shuffle(order, random);
  std::vector<Loop> mixed;
  for (const auto k : order) mixed.push_back(loops[k]);
  const auto of_mixed = judge_loops(mixed, drive.drifted, {});
  for (std::size_t k = 0; k < order.size(); ++k)
    EXPECT_EQ(of_mixed[k], verdicts[order[k]]) << order[k];
}

/// Ten times as large with ten times the lengths, and angles per metre a tenth: the same verdicts.
TEST(LoopConsistency, HasNoLengthOfItsOwn) {
  const Drive drive = two_laps(7);
  auto loops = right_loops(drive, 7);
  std::mt19937 random(7);
  for (std::size_t k = 2; k < loops.size(); k += 5)
    loops[k].T_i_j.translation += 20 * gauss3(random, 1).normalized();
  const auto verdicts = judge_loops(loops, drive.drifted, {});
  Poses large = drive.drifted;
  for (auto& T : large.T_world_segment) T.translation *= 10;
  for (auto& loop : loops) loop.T_i_j.translation *= 10, loop.sigma_translation *= 10;
  ConsistencyOptions options;
  options.drift.rotation_per_metre /= 10;
  options.drift.correlation_length *= 10, options.max_path_separation *= 10,
      options.max_unconfirmed_sigma *= 10;
  EXPECT_EQ(judge_loops(loops, large, options), verdicts);
}

TEST(LoopConsistency, JudgesNothingWhereThereIsNothing) {
  EXPECT_TRUE(judge_loops({}, Poses(), {}).empty());
  EXPECT_TRUE(judge_loops({}, two_laps(1).drifted, {}).empty());
}

// ---- the step
// ---------------------------------------------------------------------------------------------------------------

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
  try {
    pruning(registered(right_loops(two_laps(1), 1), 96), few)
        .run<Constraints>("constraints", context);
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(),
                 "a loop names segment 48, but got 40 poses: wire poses of the same segments");
  }
}

}  // namespace
}  // namespace plumb::prune_loop_consistency
