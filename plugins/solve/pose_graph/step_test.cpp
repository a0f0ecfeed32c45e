#include <gmock/gmock.h>

#include "graph_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb {
namespace {

struct Held : Collection {
  std::vector<AnyValue> items;
  Edges graph;
  std::size_t size() const override { return items.size(); }
  AnyValue open(std::size_t k) const override { return items[k]; }
  const Edges* edges() const override { return &graph; }
};

struct Solved {
  Poses poses;
  Metrics metrics;
};

Solved run(const TestGraph& g, const ParameterValues& values, TestContext& context, bool wire_matches = true) {
  auto held = std::make_shared<Held>();
  held->graph = {static_cast<std::uint32_t>(g.truth.size()), g.edges};
  for (const auto& m : g.matches) held->items.push_back(any_value(m));
  PortInput inputs[3];
  inputs[0].wired = true;
  inputs[0].one = any_value(g.drifted);
  inputs[1].wired = wire_matches;
  inputs[1].each = held;
  PortOutput outputs[2];
  const Step& step = *plumb_module()->steps[0];
  step.run(step.parameters(values).get(), inputs, outputs, context);
  return {*outputs[0].one.as<Poses>(), *outputs[1].one.as<Metrics>()};
}

TEST(SolvePoseGraph, TakesItsParametersAndGivesPosesAndARecordForEachEdge) {
  const auto g = circle(20, 2, 1);
  TestContext context;
  const auto solved = run(g, {{"loss", std::string("geman_mcclure")}, {"anneal_from", 10.0}}, context);
  EXPECT_LT(ate(solved.poses, g.truth), 0.1);
  ASSERT_EQ(solved.metrics.edges.size(), g.edges.size());
  EXPECT_EQ(solved.metrics.edges[0].kept, 40u);
  EXPECT_TRUE(context.warnings.empty());
}

TEST(SolvePoseGraph, WarnsWhereTheGraphFallsApart) {
  auto g = circle(6, 1, 1);
  g.matches[2] = Matches();
  TestContext context;
  run(g, {}, context);
  EXPECT_THAT(context.warnings, testing::ElementsAre(testing::HasSubstr("falls into 2 parts")));
}

TEST(SolvePoseGraph, RefusesToSolveNothing) {
  TestContext context;
  EXPECT_THROW(run(circle(6, 1, 1), {}, context, false), Error);
}

TEST(SolvePoseGraph, RefusesParametersThatDoNotGoTogether) {
  const Step& step = *plumb_module()->steps[0];
  EXPECT_THROW(step.parameters({{"odometry_translation", 0.1}}), Error);
  EXPECT_THROW(step.parameters({{"scale", 1.0}, {"anneal_from", 0.5}}), Error);
}

}  // namespace
}  // namespace plumb
