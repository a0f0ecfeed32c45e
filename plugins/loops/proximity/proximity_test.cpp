#include "proximity.hpp"

#include <gtest/gtest.h>

#include <random>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::loops_proximity {
namespace {

Poses along(const std::vector<Eigen::Vector3d>& places) {
  Poses poses;
  for (const auto& place : places)
    poses.T_world_segment.emplace_back(Eigen::Quaterniond::Identity(), place);
  return poses;
}

/// There and back on a line, 1 m a segment, the path back 0.5 m to the side.
Poses there_and_back(int length) {
  std::vector<Eigen::Vector3d> places;
  for (int k = 0; k < length; ++k) places.emplace_back(k, 0, 0);
  for (int k = length - 1; k >= 0; --k) places.emplace_back(k, 0.5, 0);
  return along(places);
}

TEST(Revisits, JoinEachSegmentOfTheWayBackWithItsNeighbourOnTheWayThere) {
  const Edges edges = revisits(there_and_back(20), {1.2, 5, 0});
  ASSERT_FALSE(edges.list.empty());
  EXPECT_EQ(edges.segments, 40u);
  for (const auto& edge : edges.list) {
    EXPECT_EQ(edge.kind, EdgeKind::neighbour);
    if (edge.j - edge.i < 8)
      continue;  // next to where it turned round the nearest is too near along the path
    EXPECT_EQ(edge.i + edge.j, 39u);
    EXPECT_FLOAT_EQ(edge.centroid_distance, 0.5f);
  }
  EXPECT_NEAR(edges.size(), 17, 1);
}

TEST(Revisits, GiveOneEdgeForEachVisit) {
  std::vector<Eigen::Vector3d> places;
  for (int round = 0; round < 4; ++round)
    for (int k = 0; k < 40; ++k) {
      const double angle = 2 * M_PI * k / 40;
      places.emplace_back(6 * std::cos(angle), 6 * std::sin(angle), 0);
    }
  const Edges edges = revisits(along(places), {1.5, 5, 0});
  std::map<std::uint32_t, int> visits;
  for (const auto& edge : edges.list) ++visits[edge.j];
  EXPECT_EQ(visits[139], 3);
  for (const auto& edge : edges.list) {
    if (edge.i > 0 && edge.j % 40 > 5 && edge.j - edge.i > 10) {
      EXPECT_EQ((edge.j - edge.i) % 40, 0u) << edge.i << ' ' << edge.j;
    }
  }
}

TEST(Revisits, AreWhatComparingEachPairGives) {
  std::mt19937 random(7);
  std::normal_distribution<double> step(0, 0.8);
  std::vector<Eigen::Vector3d> places{{0, 0, 0}};
  for (int k = 0; k < 300; ++k)
    places.push_back(places.back() + Eigen::Vector3d(step(random), step(random), 0));
  const Poses poses = along(places);
  const ProximityOptions options{1.5, 4, 0.3};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
  std::vector<double> path(places.size(), 0);
  for (std::size_t k = 1; k < places.size(); ++k)
    path[k] = path[k - 1] + (places[k] - places[k - 1]).norm();
  for (std::uint32_t j = 0; j < places.size(); ++j) {
    int nearest = -1;
    const auto close = [&] {
      if (nearest >= 0) expected.emplace_back(nearest, j);
      nearest = -1;
    };
    for (std::uint32_t i = 0; i < j; ++i) {
      const double d = (places[i] - places[j]).norm();
      if (path[j] - path[i] < options.min_path_separation || d > options.max_distance)
        close();
      else if (nearest < 0 || d < (places[nearest] - places[j]).norm())
        nearest = static_cast<int>(i);
    }
    close();
  }
  std::sort(expected.begin(), expected.end());
  const Edges edges = revisits(poses, options);
  ASSERT_EQ(edges.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_EQ(std::pair(edges.list[k].i, edges.list[k].j), expected[k]);
}

TEST(RevisitsStep, HasNothingToJoinOnAStraightWay) {
  StepUnderTest step(*plumb_module());
  TestContext context;
  step.with("poses", along({{0, 0, 0}, {5, 0, 0}, {10, 0, 0}}));
  EXPECT_EQ(step.run<Edges>("edges", context).size(), 0u);
}

}  // namespace
}  // namespace plumb::loops_proximity
