#include "loop_consistency.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "two_laps_testing.hpp"

namespace plumb::prune_loop_consistency {
namespace {

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

/// The same motion of the world for all of them: they agree.
void move_alike(std::vector<Loop>& loops, std::size_t first, std::size_t count,
                const Drive& drive) {
  const Pose motion(exp_rotation({0, 0, 0.02}), {9, -12, 0});
  for (std::size_t k = first; k < first + count; ++k) {
    const Pose& T_world_i = drive.truth.T_world_segment[loops[k].i];
    loops[k].T_i_j = T_world_i.inverse() * motion * T_world_i * loops[k].T_i_j;
  }
}

TEST(LoopConsistency, BelievesNeitherOfTwoGroupsThatContradictEachOther) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const Drive drive = two_laps(seed, 0.3);
    std::mt19937 random(seed);
    std::vector<Loop> loops;
    for (std::uint32_t k = 0; k < 9; ++k)
      loops.push_back(right_loop(drive, k, k + Drive::lap, random));
    move_alike(loops, 0, 5, drive);  // five against four
    const auto verdicts = judge_loops(loops, drive.drifted, {});
    EXPECT_EQ(count(verdicts, LoopVerdict::undecided), 9u) << seed;
  }
}

TEST(LoopConsistency, BelievesTheManyAgainstAFewThatAgree) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const Drive drive = two_laps(seed, 0.3);
    std::mt19937 random(seed);
    std::vector<Loop> loops;
    for (const std::uint32_t beside : {0u, 1u, 2u})
      for (std::uint32_t k = 0; k < 14; ++k)
        loops.push_back(right_loop(drive, k, k + Drive::lap + beside, random));
    move_alike(loops, 5, 3, drive);
    const auto verdicts = judge_loops(loops, drive.drifted, {});
    for (std::size_t k = 0; k < loops.size(); ++k)
      EXPECT_EQ(verdicts[k], k >= 5 && k < 8 ? LoopVerdict::against_loops : LoopVerdict::kept)
          << "seed " << seed << ", loop " << k;
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

}  // namespace
}  // namespace plumb::prune_loop_consistency
