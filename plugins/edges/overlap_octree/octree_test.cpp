#include "octree.hpp"

#include <gmock/gmock.h>

#include <array>
#include <set>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/overlapping/neighbours.hpp"

namespace plumb::edges_overlap_octree {
namespace {

using overlapping::lattice_over;
using overlapping::world_box;

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
/// Straight from the definition: for each point, whether the other cloud has a point in its voxel.
double brute_force_overlap(const Cloud& a, const Pose& T_a, const Cloud& b, const Pose& T_b,
                           double size) {
  const auto cell = [&](const Cloud& c, const Pose& T, std::size_t k) -> Cell {
    const Eigen::Vector3d world = T * c.point(k).cast<double>().eval();
    const Eigen::Vector3d whole = (world / size).array().floor();
    return {static_cast<std::int64_t>(whole.x()), static_cast<std::int64_t>(whole.y()),
            static_cast<std::int64_t>(whole.z())};
  };
  std::set<Cell> of_a, of_b;
  for (std::size_t k = 0; k < a.size(); ++k) of_a.insert(cell(a, T_a, k));
  for (std::size_t k = 0; k < b.size(); ++k) of_b.insert(cell(b, T_b, k));
  std::size_t both = 0;
  for (std::size_t k = 0; k < a.size(); ++k) both += of_b.contains(cell(a, T_a, k));
  for (std::size_t k = 0; k < b.size(); ++k) both += of_a.contains(cell(b, T_b, k));
  return static_cast<double>(both) / static_cast<double>(a.size() + b.size());
}

double overlap_of(const Cloud& a, const Pose& T_a, const Cloud& b, const Pose& T_b, double size) {
  const auto lattice = lattice_over({world_box(box_of(a), T_a), world_box(box_of(b), T_b)}, size);
  return overlap(CloudOctree(a, T_a, lattice), CloudOctree(b, T_b, lattice));
}

TEST(OctreeOverlap, AgreesWithBruteForce) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Cloud a = random_cloud(3000, {20, 10, 3}, seed),
                b = random_cloud(2000, {15, 15, 4}, seed + 100);
    const Pose T_a = at(3.3, -100, 7, 0.3 * static_cast<double>(seed)), T_b = at(9, -104, 8, -1.0);
    for (const double size : {0.5, 1.0, 3.0}) {
      const double judge = brute_force_overlap(a, T_a, b, T_b, size);
      EXPECT_DOUBLE_EQ(overlap_of(a, T_a, b, T_b, size), judge);
      EXPECT_GT(judge, 0.01);
    }
  }
}

TEST(OctreeOverlap, OfPointsOnTheBordersOfLeavesIsThatOfTheVoxels) {
  // Every coordinate is a whole multiple of the leaf: a point belongs to the leaf that begins
  // there.
  Cloud a, b;
  for (const float x : {0.f, 1.f, 2.f, 3.f}) a.add({x, 1, 0});
  for (const float x : {2.f, 2.5f, 5.f}) b.add({x, 1, 0});
  EXPECT_DOUBLE_EQ(overlap_of(a, Pose(), b, Pose(), 1), 3.0 / 7);
}

TEST(OctreeOverlap, IsOneWithItselfAndNothingWithNothing) {
  const Cloud a = random_cloud(500, {9, 9, 2}, 1);
  EXPECT_DOUBLE_EQ(overlap_of(a, at(1, 2, 3), a, at(1, 2, 3), 0.5), 1);
  EXPECT_DOUBLE_EQ(overlap_of(a, Pose(), Cloud(), Pose(), 1), 0);
  EXPECT_DOUBLE_EQ(overlap_of(Cloud(), Pose(), Cloud(), Pose(), 1), 0);
  EXPECT_DOUBLE_EQ(overlap_of(a, Pose(), a, at(100, 0, 0), 1), 0);
}

TEST(OctreeOverlapEdges, AreThosePairsThatBruteForceFinds) {
  std::vector<Segment> segments;  // blocks of 20 m x 10 m, one every 8 m, there and back again
  Poses poses;
  for (std::uint64_t k = 0; k < 10; ++k) {
    segments.push_back(
        Segment().with(random_cloud(2000, {10, 5, 1}, k + 1), std::vector<std::uint16_t>(2000, 0)));
    poses.T_world_segment.push_back(
        at(8 * static_cast<double>(std::min<std::uint64_t>(k, 9 - k)), 0, 0));
  }
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.each("segments", segments).with("poses", poses).set("resolution", 2.0);
  const auto edges = step.run<Edges>("edges", context);
  const auto judge = [&](std::size_t i, std::size_t j) {
    return brute_force_overlap(segments[i].cloud, poses.T_world_segment[i], segments[j].cloud,
                               poses.T_world_segment[j], 2);
  };
  double smallest = 1;
  for (std::size_t k = 0; k < 9; ++k) smallest = std::min(smallest, judge(k, k + 1));
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < 10; ++i)
    for (std::uint32_t j = i + 1; j < 10; ++j) {
      const double exact = judge(i, j);
      if (j != i + 1 && exact <= 0.9 * smallest) continue;
      ASSERT_LT(next, edges.size());
      EXPECT_EQ(std::pair(edges.list[next].i, edges.list[next].j), std::pair(i, j));
      EXPECT_FLOAT_EQ(edges.list[next].score, static_cast<float>(exact));
      ++next;
    }
  EXPECT_EQ(next, edges.size());
  EXPECT_GT(next, 13u);
}

TEST(OctreeOverlapEdges, RefusePosesOfOtherSegments) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.each("segments", std::vector<Segment>(3)).with("poses", Poses());
  EXPECT_THROW(step.run<Edges>("edges", context), Error);
}

}  // namespace
}  // namespace plumb::edges_overlap_octree
