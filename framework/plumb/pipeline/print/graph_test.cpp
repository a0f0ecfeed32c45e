#include "plumb/pipeline/print/graph.hpp"

#include <gmock/gmock.h>

#include "plumb/pipeline/testing/test_steps.hpp"

namespace plumb {
namespace {

using testing::HasSubstr;

Plan plan() {
  const test::Folder folder;
  return read_pipeline(folder.write("a.yaml", test::cascade), {{}, {"input=data"}, false},
                       test::registry());
}

TEST(Graph, DrawsStepsTypesGroupsAndRepeatsInMermaid) {
  const std::string text = mermaid_graph(plan());
  EXPECT_EQ(text.rfind("flowchart TD\n", 0), 0u);
  EXPECT_THAT(text, HasSubstr("s0[\"sequence<br/>source.sequence\"]"));
  EXPECT_THAT(text, HasSubstr("s0 -->|Trajectory| s1"));
  EXPECT_THAT(text, HasSubstr("subgraph g0[\"coarse: 2 to 6 passes\"]"));
  EXPECT_THAT(text, HasSubstr("subgraph g1[\"drift\"]"));
  EXPECT_THAT(text, HasSubstr("r0c0([\"poses\"])"));
  EXPECT_THAT(text, HasSubstr("-.->|next pass| r0c0"));
  EXPECT_THAT(text, HasSubstr("r0c0 -->|Poses|"));
}

TEST(Graph, DrawsTheSameInDot) {
  const std::string text = dot_graph(plan());
  EXPECT_EQ(text.rfind("digraph \"cascade\" {\n", 0), 0u);
  EXPECT_THAT(text, HasSubstr("s0 [label=\"sequence\\nsource.sequence\"];"));
  EXPECT_THAT(text, HasSubstr("s0 -> s1 [label=\"Trajectory\"];"));
  EXPECT_THAT(text, HasSubstr("subgraph cluster_g0 { label=\"coarse: 2 to 6 passes\";"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
}

}  // namespace
}  // namespace plumb
