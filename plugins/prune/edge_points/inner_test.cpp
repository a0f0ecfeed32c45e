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

TEST(EdgePoints, RefusesPairsWithoutBorderMarks) {
  Matches unmarked = four_pairs();
  unmarked.at_border.clear();
  EXPECT_THROW(inner(unmarked), Error);
}

TEST(EdgePoints, LetsNoPairsThrough) { EXPECT_TRUE(inner(Matches()).empty()); }

}  // namespace
}  // namespace plumb::prune_edge_points
