#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <set>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/step.hpp"
#include "voxels.hpp"

namespace plumb::edges_overlap {
namespace {

Cloud random_cloud(std::size_t count, const Eigen::Vector3f& half, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k)
    cloud.add({half.x() * static_cast<float>(2 * random.uniform() - 1),
               half.y() * static_cast<float>(2 * random.uniform() - 1),
               half.z() * static_cast<float>(2 * random.uniform() - 1)});
  return cloud;
}
Pose at(double x, double y, double z, double yaw = 0) {
  return {exp_rotation({0, 0, yaw}), {x, y, z}};
}

using Cell = std::array<std::int64_t, 3>;
Cell cell_of(const Eigen::Vector3d& world, double size) {
  const Eigen::Vector3d c = (world / size).array().floor();
  return {static_cast<std::int64_t>(c.x()), static_cast<std::int64_t>(c.y()),
          static_cast<std::int64_t>(c.z())};
}

/// Straight from the definition: for each point, whether the other cloud has a point in its voxel.
double brute_force_overlap(const Cloud& a, const Pose& T_a, const Cloud& b, const Pose& T_b,
                           double size) {
  const auto world = [](const Cloud& c, const Pose& T, std::size_t k) -> Eigen::Vector3d {
    return T * c.point(k).cast<double>().eval();
  };
  std::set<Cell> of_a, of_b;
  for (std::size_t k = 0; k < a.size(); ++k) of_a.insert(cell_of(world(a, T_a, k), size));
  for (std::size_t k = 0; k < b.size(); ++k) of_b.insert(cell_of(world(b, T_b, k), size));
  std::size_t both = 0;
  for (std::size_t k = 0; k < a.size(); ++k) both += of_b.contains(cell_of(world(a, T_a, k), size));
  for (std::size_t k = 0; k < b.size(); ++k) both += of_a.contains(cell_of(world(b, T_b, k), size));
  return static_cast<double>(both) / static_cast<double>(a.size() + b.size());
}

double overlap_of(const Cloud& a, const Pose& T_a, const Cloud& b, const Pose& T_b, double size,
                  double least = 0) {
  const auto lattice = lattice_over({world_box(box_of(a), T_a), world_box(box_of(b), T_b)}, size);
  return overlap(voxels_of(a, T_a, lattice), voxels_of(b, T_b, lattice), least);
}

TEST(Overlap, AgreesWithBruteForce) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Cloud a = random_cloud(3000, {20, 10, 3}, seed),
                b = random_cloud(2000, {15, 15, 4}, seed + 100);
    const Pose T_a = at(3.3, -100, 7, 0.3 * static_cast<double>(seed)), T_b = at(9, -104, 8, -1.0);
    for (const double size : {0.5, 1.0, 3.0}) {
      const double judge = brute_force_overlap(a, T_a, b, T_b, size);
      EXPECT_DOUBLE_EQ(overlap_of(a, T_a, b, T_b, size), judge);
      EXPECT_DOUBLE_EQ(overlap_of(a, T_a, b, T_b, size, 0.9 * judge), judge)
          << "not pruned too early";
      EXPECT_GT(judge, 0.01);
    }
  }
}

TEST(Overlap, IsOneWithItselfAndTheSameBothWays) {
  const Cloud a = random_cloud(500, {9, 9, 2}, 1), b = random_cloud(700, {9, 5, 2}, 2);
  EXPECT_DOUBLE_EQ(overlap_of(a, at(1, 2, 3), a, at(1, 2, 3), 0.5), 1);
  EXPECT_DOUBLE_EQ(overlap_of(a, at(1, 2, 3), b, at(3, 2, 3), 0.5),
                   overlap_of(b, at(3, 2, 3), a, at(1, 2, 3), 0.5));
}

TEST(Overlap, CountsThePointsInSharedVoxels) {
  Cloud a, b;
  for (const float x : {0.5f, 0.6f, 1.5f}) a.add({x, 0.5f, 0.5f});
  for (const float x : {0.9f, 2.5f}) b.add({x, 0.5f, 0.5f});
  EXPECT_DOUBLE_EQ(overlap_of(a, Pose(), b, Pose(), 1), 3.0 / 5);
  EXPECT_DOUBLE_EQ(overlap_of(a, Pose(), Cloud(), Pose(), 1), 0);
}

TEST(Overlap, DoesNotCareForLargeWorldCoordinates) {
  const Cloud a = random_cloud(3000, {20, 10, 3}, 1), b = random_cloud(3000, {20, 10, 3}, 2);
  const Eigen::Vector3d utm(524288, 5767168, 128);  // whole voxels, so that the lattice cuts alike
  Pose T_a = at(0, 0, 0, 0.25), T_b = at(4, 2, 0, -0.5);
  const double near = overlap_of(a, T_a, b, T_b, 1);
  T_a.translation += utm, T_b.translation += utm;
  EXPECT_NEAR(overlap_of(a, T_a, b, T_b, 1), near, 1e-3);
}

TEST(Morton, NestsEightVoxelsInOne) {
  EXPECT_EQ(morton(0, 0, 0), 0u);
  EXPECT_EQ(morton(1, 0, 0), 1u);
  EXPECT_EQ(morton(0, 1, 0), 2u);
  EXPECT_EQ(morton(0, 0, 1), 4u);
  EXPECT_EQ(morton((1 << 21) - 1, (1 << 21) - 1, (1 << 21) - 1), (1ull << 63) - 1);
  for (std::uint32_t x : {5u, 77777u, 2000001u})
    EXPECT_EQ(morton(x, x + 3, x / 2) >> 3, morton(x / 2, (x + 3) / 2, x / 4));
}

/// Blocks of 20 m x 10 m along x, one every `step` metres, there and back again.
struct OutAndBack {
  std::vector<Segment> segments;
  Poses poses;
  OutAndBack(int count, double step, double far_off = 0) {
    for (int k = 0; k < count; ++k) {
      segments.push_back(
          segment_of(random_cloud(4000, {10, 5, 1}, static_cast<std::uint64_t>(k) + 1)));
      const double x = step * std::min(k, count - 1 - k);
      poses.T_world_segment.push_back(at(k == count - 1 ? x + far_off : x, 0, 0));
    }
  }
  Edges run(TestContext& context, std::optional<double> threshold = {}) const {
    StepUnderTest step(*plumb_module());
    step.each("segments", segments).with("poses", poses).set("resolution", 2.0);
    if (threshold) step.set("threshold", *threshold);
    return step.run<Edges>("edges", context);
  }
};

TEST(OverlapEdges, AreThosePairsThatBruteForceFinds) {
  const OutAndBack drive(10, 8);
  TestContext context;
  const Edges edges = drive.run(context);
  std::vector<double> judge;
  const auto pair = [&](std::uint32_t i, std::uint32_t j) {
    return brute_force_overlap(drive.segments[i].cloud, drive.poses.T_world_segment[i],
                               drive.segments[j].cloud, drive.poses.T_world_segment[j], 2);
  };
  double smallest = 1;
  for (std::uint32_t k = 0; k < 9; ++k) smallest = std::min(smallest, pair(k, k + 1));
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < 10; ++i)
    for (std::uint32_t j = i + 1; j < 10; ++j) {
      const double exact = pair(i, j);
      if (j != i + 1 && exact <= 0.9 * smallest) continue;
      ASSERT_LT(next, edges.size());
      EXPECT_EQ(std::pair(edges.list[next].i, edges.list[next].j), std::pair(i, j));
      EXPECT_EQ(edges.list[next].kind, j == i + 1 ? EdgeKind::sequential : EdgeKind::neighbour);
      EXPECT_FLOAT_EQ(edges.list[next].score, static_cast<float>(exact));
      ++next;
    }
  EXPECT_EQ(next, edges.size());
  EXPECT_GT(next, 13u);  // the way back is seen
  EXPECT_EQ(context.counts["neighbours"], next - 9);
  EXPECT_TRUE(context.warnings.empty());
}

TEST(OverlapEdges, SayThatConsecutiveSegmentsDoNotOverlapAndGoOn) {
  const OutAndBack drive(8, 8, 500);
  TestContext context;
  const Edges edges = drive.run(context);
  ASSERT_EQ(context.warnings.size(), 1u);
  EXPECT_THAT(context.warnings[0], testing::HasSubstr("segments 6 and 7"));
  const auto sequential = std::ranges::count(edges.list, EdgeKind::sequential, &Edge::kind);
  EXPECT_EQ(sequential, 7);
  for (const Edge& e : edges.list) EXPECT_TRUE(e.kind == EdgeKind::sequential || e.score > 0.05f);
}

TEST(OverlapEdges, FollowAGivenThreshold) {
  const OutAndBack drive(10, 8);
  TestContext context;
  EXPECT_EQ(drive.run(context, 1.0).size(), 9u);
  EXPECT_GT(drive.run(context, 0.2).size(), drive.run(context, 0.5).size());
}

TEST(OverlapEdges, RefuseFewerThanTwoSegmentsForThereIsNothingToRegister) {
  for (std::size_t count : {0, 1}) {
    TestContext context;
    Poses poses;
    poses.T_world_segment.resize(count);
    StepUnderTest step(*plumb_module());
    step.each("segments", std::vector<Segment>(count)).with("poses", poses);
    EXPECT_THROW(step.run<Edges>("edges", context), Error);
  }
}

TEST(OverlapEdges, JoinEmptySegmentsThatFollowEachOtherAndSaySo) {
  TestContext context;
  Poses three;
  three.T_world_segment.resize(3);
  EXPECT_EQ(StepUnderTest(*plumb_module())
                .each("segments", std::vector<Segment>(3))
                .with("poses", three)
                .run<Edges>("edges", context)
                .size(),
            2u);
  EXPECT_EQ(context.warnings.size(), 2u);
}

TEST(OverlapEdges, RefusePosesOfOtherSegments) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.each("segments", std::vector<Segment>(3)).with("poses", Poses());
  EXPECT_THROW(step.run<Edges>("edges", context), Error);
}

TEST(OverlapEdges, RefuseSegmentsThatLieTooFarApartForTheirVoxels) {
  OutAndBack drive(3, 8);
  drive.poses.T_world_segment[1].translation.x() = 1e9;
  TestContext context;
  EXPECT_THROW(drive.run(context), Error);
}

}  // namespace
}  // namespace plumb::edges_overlap
