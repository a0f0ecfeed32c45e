#include "join.hpp"

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::edges_union {
namespace {

constexpr auto sequential = EdgeKind::sequential;
constexpr auto loop = EdgeKind::loop;
constexpr auto neighbour = EdgeKind::neighbour;

TEST(UnionOfEdges, HoldsEachPairOnceInOrder) {
  const Edges a{4, {{0, 1, sequential}, {1, 2, sequential}}};
  const Edges b{4, {{0, 3, loop}, {1, 3, neighbour}}};
  const Edges all = joined({&a, &b});
  ASSERT_EQ(all.size(), 4u);
  const std::pair<unsigned, unsigned> expected[] = {{0, 1}, {0, 3}, {1, 2}, {1, 3}};
  for (int k = 0; k < 4; ++k) EXPECT_EQ(std::pair(all.list[k].i, all.list[k].j), expected[k]);
}

TEST(UnionOfEdges, LetsTheFirstToNameAPairDecide) {
  const Edges a{3, {{0, 2, neighbour, 0.5f}}};
  const Edges b{3, {{0, 2, loop, 0.9f}}};
  EXPECT_EQ(joined({&a, &b}).list.front().kind, neighbour);
  EXPECT_EQ(joined({&b, &a}).list.front().kind, loop);
  TestContext context;
  const auto all = StepUnderTest(*plumb_module())
                       .add("edges", "a", a)
                       .add("edges", "b", b)
                       .run<Edges>("edges", context);
  EXPECT_EQ(all.size(), 1u);
  EXPECT_EQ(context.counts["edges named more than once"], 1u);
}

TEST(UnionOfEdges, RefusesEdgesOfOtherSegments) {
  const Edges a{3, {{0, 2, loop}}}, b{4, {{0, 2, loop}}};
  EXPECT_THROW(joined({&a, &b}), std::runtime_error);
}

TEST(UnionOfEdges, OfNothingIsNothing) { EXPECT_EQ(joined({}).size(), 0u); }

}  // namespace
}  // namespace plumb::edges_union
