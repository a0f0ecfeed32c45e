#include "sequential.hpp"

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::edges_sequential {
namespace {

TEST(SequentialEdges, JoinEachSegmentWithTheNext) {
  const Edges edges = sequential_edges({{0, 0, 0}, {3, 4, 0}, {3, 4, 2}});
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges.segments, 3u);
  EXPECT_EQ(edges.list[0].i, 0u);
  EXPECT_EQ(edges.list[0].j, 1u);
  EXPECT_EQ(edges.list[0].kind, EdgeKind::sequential);
  EXPECT_FLOAT_EQ(edges.list[0].centroid_distance, 5);
  EXPECT_EQ(edges.list[1].i, 1u);
  EXPECT_EQ(edges.list[1].j, 2u);
  EXPECT_FLOAT_EQ(edges.list[1].score, 1);
}

TEST(SequentialEdges, AreNoneForOneSegmentAndThatIsSaid) {
  EXPECT_EQ(sequential_edges({}).size(), 0u);
  TestContext context;
  const auto edges = StepUnderTest(*plumb_module())
                         .each("ranges", std::vector<FrameRange>(1))
                         .run<Edges>("edges", context);
  EXPECT_EQ(edges.size(), 0u);
  EXPECT_EQ(edges.segments, 1u);
  EXPECT_EQ(context.warnings.size(), 1u);
}

TEST(SequentialEdges, TakePlacesFromTheRanges) {
  std::vector<FrameRange> ranges(3);
  for (int k = 0; k < 3; ++k) ranges[k].T_world_segment.translation.x() = 5e6 + 10 * k;
  TestContext context;
  const auto edges =
      StepUnderTest(*plumb_module()).each("ranges", ranges).run<Edges>("edges", context);
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_FLOAT_EQ(edges.list[1].centroid_distance, 10);
}

}  // namespace
}  // namespace plumb::edges_sequential
