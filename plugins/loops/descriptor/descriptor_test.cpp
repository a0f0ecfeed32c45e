#include "descriptor.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <set>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::loops_descriptor {
namespace {

/// A drive: where each segment really is, and where a drifting odometry has it.
struct Drive {
  std::vector<Eigen::Vector3d> truth, drifted;

  void to(double x, double y) {
    const double k = static_cast<double>(truth.size());
    truth.push_back({x, y, 0});
    drifted.push_back(truth.back() + Eigen::Vector3d(0.25 * k, -0.15 * k, 0.05 * k));
  }
  Places places() const { return {drifted, drifted}; }
  /// Looks fade over 20 m.
  double alike(std::uint32_t i, std::uint32_t j) const {
    return std::exp(-(truth[i] - truth[j]).norm() / 20);
  }
  Loops loops(const LoopOptions& options = {}) const {
    return find_loops(
        places(), [this](auto i, auto j) { return alike(i, j); }, options);
  }
};

/// `count` segments out along a street, every 10 m, and `count` back.
Drive out_and_back(int count) {
  Drive drive;
  for (int k = 0; k < count; ++k) drive.to(10 * k, 0);
  for (int k = count - 1; k >= 0; --k) drive.to(10 * k, 2);
  return drive;
}
/// Twice the same way round a circle of `count` segments.
Drive twice_round(int count) {
  Drive drive;
  const double radius = 10 * count / (2 * std::numbers::pi);
  for (int k = 0; k < 2 * count; ++k) {
    const double turn = 2 * std::numbers::pi * k / count;
    drive.to(radius * std::cos(turn), radius * std::sin(turn));
  }
  return drive;
}
LoopOptions once() {
  LoopOptions options;
  options.loops_per_segment = 1;
  return options;
}

TEST(Loops, PairTheWayBackWithTheWayOut) {
  const auto edges = out_and_back(20).loops(once()).edges;
  std::set<std::uint32_t> covered;
  for (const Edge& e : edges.list) {
    EXPECT_EQ(e.kind, EdgeKind::loop);
    EXPECT_LT(e.i, e.j);
    EXPECT_EQ(e.i + e.j, 39u) << e.i << " " << e.j;
    covered.insert(e.i);
  }
  EXPECT_GE(covered.size(),
            17u);  // all but those by the turning point, with too little path between
}

TEST(Loops, PairTheSecondRoundWithTheFirst) {
  const auto loops = twice_round(24).loops(once());
  std::set<std::uint32_t> covered;
  for (const Edge& e : loops.edges.list)
    if (e.j - e.i == 24) covered.insert(e.i);
  EXPECT_EQ(covered.size(), 24u);
  EXPECT_LE(loops.edges.size(), 26u);  // and where the round closes
}

TEST(Loops, AreNotMadeUpOnAStreetWithoutReturn) {
  Drive street;
  for (int k = 0; k < 60; ++k) street.to(10 * k, 20 * std::sin(0.1 * k));
  EXPECT_EQ(street.loops().edges.size(), 0u);
}

TEST(Loops, OfSeparatePlacesAreAllFound) {
  // A street, far off a block driven round twice, then the street again.
  Drive drive;
  for (int k = 0; k < 15; ++k) drive.to(10 * k, 0);
  for (int k = 0; k < 40; ++k) drive.to(400 + 32 * std::cos(0.3 * k), 32 * std::sin(0.3 * k));
  for (int k = 0; k < 15; ++k) drive.to(10 * k, 1);
  const auto loops = drive.loops(once());
  std::set<std::uint32_t> covered;
  for (const Edge& e : loops.edges.list) {
    covered.insert(e.i);
    covered.insert(e.j);
    EXPECT_LT((drive.truth[e.i] - drive.truth[e.j]).norm(), 25);
  }
  EXPECT_GE(loops.walks, 2u);
  EXPECT_GE(covered.size(), 55u);
}

TEST(Loops, StayWithinWhatDriftExplains) {
  auto options = once();
  options.drift = 0;
  options.max_centroid_distance = 3;
  for (const Edge& e : out_and_back(30).loops(options).edges.list)
    EXPECT_LE(e.centroid_distance, 3);
}

TEST(Loops, EndTheirWalkAtTheThreshold) {
  Drive drive = out_and_back(20);
  auto options = once();
  options.threshold = 0.8;
  const auto different = [&](std::uint32_t i, std::uint32_t j) {
    return i < 8 ? 0.5 : drive.alike(i, j);  // rebuilt while we were away
  };
  for (const Edge& e : find_loops(drive.places(), different, options).edges.list) {
    EXPECT_GE(e.i, 8u);
    EXPECT_GE(e.score, 0.8f);
  }
}

TEST(Loops, GrowNoFasterThanTheSegments) {
  Drive drive;  // eight times the same round: every segment has many partners
  for (int k = 0; k < 160; ++k) drive.to(32 * std::cos(0.314159 * k), 32 * std::sin(0.314159 * k));
  for (const std::uint32_t each : {1u, 2u, 3u}) {
    auto options = once();
    options.loops_per_segment = each;
    const auto edges = drive.loops(options).edges;
    EXPECT_LE(edges.size(), each * 160);
    std::vector<std::uint32_t> loops_of(160, 0);
    for (const Edge& e : edges.list) ++loops_of[e.i], ++loops_of[e.j];
    EXPECT_GT(std::ranges::count_if(loops_of, [&](auto n) { return n >= each; }), 140);
  }
}

TEST(Loops, OfOneWalkByStepsOfTwoAreEverySecondPairFromTheSeed) {
  auto options = once();
  options.stride = 2;
  options.max_walks = 1;
  const auto loops = twice_round(24).loops(options);
  EXPECT_EQ(loops.walks, 1u);
  ASSERT_EQ(loops.edges.size(), 12u);
  for (const Edge& e : loops.edges.list) {
    EXPECT_EQ(e.j - e.i, 24u);
    EXPECT_EQ(e.i % 2, loops.edges.list[0].i % 2);
  }
}

TEST(Loops, OfASingleWalkLeaveOutASecondPlace) {
  // Round a block twice, far off round another one twice.
  Drive drive;
  for (const double x : {0.0, 1000.0})
    for (int k = 0; k < 40; ++k)
      drive.to(x + 32 * std::cos(0.314159 * k), 32 * std::sin(0.314159 * k));
  auto options = once();
  const auto both = drive.loops(options);
  options.max_walks = 1;
  const auto one = drive.loops(options);
  EXPECT_GE(both.walks, 2u);
  EXPECT_EQ(one.walks, 1u);
  ASSERT_FALSE(one.edges.list.empty());
  const bool second = one.edges.list[0].i >= 40;
  for (const Edge& e : one.edges.list) {
    EXPECT_EQ(e.i >= 40, second);
    EXPECT_EQ(e.j >= 40, second);
  }
  EXPECT_LT(one.edges.size(), both.edges.size());
}

TEST(Loops, OfAStreetDrivenBackNeedTheOtherDirection) {
  auto options = once();
  options.max_walks = 1;
  EXPECT_GE(out_and_back(20).loops(options).edges.size(), 15u);
  options.either_direction = false;
  const auto edges = out_and_back(20).loops(options).edges;
  ASSERT_EQ(edges.size(), 1u);  // (i + 1, j + 1) lie 20 m apart, where no look is like another
  EXPECT_EQ(edges.list[0].i + edges.list[0].j, 39u);
}

TEST(Loops, AreOfTheNextButOneWhereTheIndexAloneSaysWhatIsAdjacent) {
  // As the paper has it: a straight street is a loop with itself.
  Drive street;
  for (int k = 0; k < 30; ++k) street.to(10 * k, 0);
  auto options = once();
  options.max_walks = 1;
  options.threshold = 0.3;
  EXPECT_TRUE(street.loops(options).edges.list.empty());
  options.min_path_separation = 0;
  options.either_direction = false;
  const auto edges = street.loops(options).edges;
  EXPECT_EQ(edges.size(), 28u);
  for (const Edge& e : edges.list) EXPECT_EQ(e.j - e.i, 2u);
}

TEST(Loops, AreOrderedAndEachPairOnce) {
  const auto edges = twice_round(30).loops().edges;
  for (std::size_t k = 1; k < edges.size(); ++k)
    EXPECT_LT(std::pair(edges.list[k - 1].i, edges.list[k - 1].j),
              std::pair(edges.list[k].i, edges.list[k].j));
  EXPECT_EQ(edges.segments, 60u);
}

/// A histogram with a bump that moves along with the place.
Descriptor look_of(const Eigen::Vector3d& place) {
  Descriptor d;
  for (int k = 0; k < 64; ++k)
    d.values.push_back(
        static_cast<float>(0.05 * std::exp(-std::pow((k - 0.2 * place.x()) / 4, 2))));
  return d;
}
StepUnderTest step_for(const Drive& drive) {
  std::vector<Descriptor> descriptors;
  Poses poses;
  for (std::size_t k = 0; k < drive.truth.size(); ++k) {
    descriptors.push_back(look_of(drive.truth[k]));
    poses.T_world_segment.push_back({Eigen::Quaterniond::Identity(), drive.drifted[k]});
  }
  StepUnderTest step(*plumb_module());
  step.each("descriptors", descriptors)
      .each("segments", std::vector<Segment>(drive.truth.size()))
      .with("poses", poses);
  return step;
}

TEST(LoopEdges, AreFoundFromDescriptorsWithEachSimilarity) {
  for (const std::string name : {"inverse_difference", "equation_1", "cosine", "chi_square"}) {
    TestContext context;
    const auto edges = step_for(out_and_back(20))
                           .set("similarity", name)
                           .set("loops_per_segment", std::int64_t(1))
                           .run<Edges>("edges", context);
    EXPECT_GE(edges.size(), 15u) << name;
    for (const Edge& e : edges.list) EXPECT_NEAR(e.i + e.j, 39, 2) << name;
    EXPECT_TRUE(context.warnings.empty());
  }
}

TEST(LoopEdges, SayThatThereIsNoLoopAndGoOn) {
  Drive street;
  for (int k = 0; k < 30; ++k) street.to(10 * k, 0);
  TestContext context;
  EXPECT_EQ(step_for(street).run<Edges>("edges", context).size(), 0u);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_THAT(context.warnings[0], testing::HasSubstr("no loop found"));
  EXPECT_EQ(step_for(Drive()).run<Edges>("edges", context).size(), 0u);
}

TEST(LoopEdges, RefuseDescriptorsOfOtherSegments) {
  StepUnderTest step = step_for(out_and_back(5));
  step.each("descriptors", std::vector<Descriptor>(3));
  TestContext context;
  EXPECT_THROW(step.run<Edges>("edges", context), Error);
}

}  // namespace
}  // namespace plumb::loops_descriptor
