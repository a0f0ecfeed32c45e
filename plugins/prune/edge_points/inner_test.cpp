#include "inner.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::prune_edge_points {
namespace {

Matches four_pairs() {
  Matches m;
  for (int k = 0; k < 4; ++k) {
    m.p.push_back({static_cast<float>(k), 0, 0});
    m.q.push_back({0, static_cast<float>(k), 0});
  }
  m.at_border = {0, 1, 0, 1};
  m.found = 4;
  return m;
}

TEST(EdgePoints, DropsPairsWithAPointAtTheBorder) {
  TestContext context;
  const auto kept =
      StepUnderTest(*plumb_module()).with("matches", four_pairs()).run<Matches>("matches", context);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept.p[0].x(), 0);
  EXPECT_EQ(kept.p[1].x(), 2);
  EXPECT_EQ(kept.found, 4u);
  EXPECT_EQ(context.counts["pairs at a border dropped"], 2u);
}

TEST(EdgePoints, DoingItTwiceChangesNothing) {
  const Matches once = select(four_pairs(), inner(four_pairs()));
  EXPECT_THAT(inner(once), testing::ElementsAre(0, 1));
}

/// Keypoints on a line, 1 m apart; the first is an edge point.
Features on_a_line(const Eigen::Vector3f& direction) {
  Features f;
  f.dimension = 1;
  for (int k = 0; k < 4; ++k) {
    f.points.push_back(static_cast<float>(k) * direction);
    f.vectors.push_back(0);
    f.at_border.push_back(k == 0);
  }
  return f;
}

TEST(EdgePoints, DropsPairsWithAPointNearAnEdgePointOfItsOwnCloud) {
  // p at 0, 1, 2, 3 m along x of the first cloud, whose edge point lies at 0; q along y of the
  // second, whose lies at 3 m.
  Features of_i = on_a_line(Eigen::Vector3f::UnitX()), of_j = on_a_line(Eigen::Vector3f::UnitY());
  of_j.at_border = {0, 0, 0, 1};
  EXPECT_THAT(inner(four_pairs(), of_i, of_j, 0), testing::ElementsAre(1, 2));
  EXPECT_THAT(inner(four_pairs(), of_i, of_j, 0.9), testing::ElementsAre(1, 2));
  EXPECT_THAT(inner(four_pairs(), of_i, of_j, 1), testing::IsEmpty());
  of_j.at_border = {0, 0, 0, 0};
  EXPECT_THAT(inner(four_pairs(), of_i, of_j, 1), testing::ElementsAre(2, 3));
  EXPECT_THAT(inner(four_pairs(), of_i, of_j, 2.5), testing::ElementsAre(3));
}

TEST(EdgePoints, WithADistanceOfZeroAreThoseWithoutMarks) {
  Features of_i = on_a_line(Eigen::Vector3f::UnitX()), of_j = on_a_line(Eigen::Vector3f::UnitY());
  of_i.at_border = {0, 1, 0, 0}, of_j.at_border = {0, 0, 0, 1};
  EXPECT_EQ(inner(four_pairs(), of_i, of_j, 0), inner(four_pairs()));
}

TEST(EdgePoints, WithADistanceNeedFeaturesWithMarks) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("matches", four_pairs()).set("distance", 1.0);
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
  const Features marked = on_a_line(Eigen::Vector3f::UnitX());
  step.ends("features", marked, marked);
  EXPECT_EQ(step.run<Matches>("matches", context).size(), 2u);  // those 2 and 3 m from the origin
  EXPECT_EQ(context.counts["pairs at a border dropped"], 2u);
  Features unmarked = marked;
  unmarked.at_border.clear();
  step.ends("features", marked, unmarked);
  EXPECT_THROW(step.run<Matches>("matches", context), Error);
}

TEST(EdgePoints, RefusesPairsWithoutBorderMarks) {
  Matches unmarked = four_pairs();
  unmarked.at_border.clear();
  EXPECT_THROW(inner(unmarked), Error);
}

TEST(EdgePoints, LetsNoPairsThrough) { EXPECT_TRUE(inner(Matches()).empty()); }

}  // namespace
}  // namespace plumb::prune_edge_points
