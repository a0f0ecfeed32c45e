#include "plumb/slam/step.hpp"

#include <gmock/gmock.h>

#include "graph_testing.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::solve_pose_graph {
namespace {

struct Solved {
  Poses poses;
  Metrics metrics;
};

Solved run(const TestGraph& g, const ParameterValues& values, TestContext& context,
           bool wire_matches = true) {
  PortInput inputs[4];
  inputs[0].wired = true;
  inputs[0].one = any_value(g.drifted);
  inputs[1].wired = wire_matches;
  inputs[1].each =
      held(g.matches, any_value(Edges{static_cast<std::uint32_t>(g.truth.size()), g.edges}));
  PortOutput outputs[3];
  const Step& step = *plumb_module()->steps[0];
  step.run(step.parameters(values).get(), inputs, outputs, context);
  return {*outputs[0].one.as<Poses>(), *outputs[1].one.as<Metrics>()};
}

TEST(SolvePoseGraph, TakesItsParametersAndGivesPosesAndARecordForEachEdge) {
  const auto g = circle(20, 2, 1);
  TestContext context;
  const auto solved =
      run(g, {{"loss", std::string("geman_mcclure")}, {"anneal_from", 10.0}}, context);
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

Constraints planar_chain(std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs,
                         bool planar = true) {
  Constraints constraints;
  constraints.planar = planar;
  for (const auto& [i, j] : pairs)
    constraints.relative.push_back({i, j,
                                    Pose(Eigen::Quaterniond::Identity(), {1.0 * (j - i), 0, 0}),
                                    100 * Matrix6d::Identity()});
  return constraints;
}

Poses solve(const std::vector<Constraints>& constraints, const ParameterValues& values,
            TestContext& context, Metrics* metrics = nullptr) {
  PortInput inputs[4];
  Poses start;
  for (int k = 0; k < 5; ++k)
    start.T_world_segment.emplace_back(Eigen::Quaterniond::Identity(),
                                       Eigen::Vector3d(1.1 * k, 0, 0));
  inputs[0].wired = inputs[2].wired = true;
  inputs[0].one = any_value(start);
  for (std::size_t k = 0; k < constraints.size(); ++k)
    inputs[2].several.emplace_back(std::string(1, static_cast<char>('a' + k)),
                                   any_value(constraints[k]));
  PortOutput outputs[3];
  const Step& step = *plumb_module()->steps[0];
  step.run(step.parameters(values).get(), inputs, outputs, context);
  if (metrics) *metrics = *outputs[1].one.as<Metrics>();
  return *outputs[0].one.as<Poses>();
}

TEST(SolvePoseGraph, JoinsSeveralConstraints) {
  TestContext context;
  Metrics metrics;
  const auto poses =
      solve({planar_chain({{0, 1}, {1, 2}}), Constraints(), planar_chain({{2, 3}, {3, 4}})}, {},
            context, &metrics);
  EXPECT_NEAR(poses.T_world_segment[4].translation.x(), 4, 1e-9);
  EXPECT_EQ(metrics.edges.size(), 4u);
  EXPECT_TRUE(context.warnings.empty());
}

TEST(SolvePoseGraph, RefusesToMixThePlaneWithSpace) {
  TestContext context;
  EXPECT_EQ(io::refusal([&] {
              solve({planar_chain({{0, 1}}), planar_chain({{1, 2}}, false)}, {}, context);
            }),
            "constraints 'a' lie in the plane and 'b' do not; they cannot be solved together");
}

TEST(SolvePoseGraph, TakesAConstraintOverALeftOutPoseForSequential) {
  TestContext context;
  Metrics metrics;
  // 1 was dropped: 0-2 has no loss, so that the wrong 0-4 does not win against it.
  auto constraints = planar_chain({{0, 2}, {2, 3}, {3, 4}, {0, 4}});
  constraints.relative[3].T_i_j.translation.x() = 9;
  const auto poses =
      solve({constraints}, {{"loss", std::string("geman_mcclure")}}, context, &metrics);
  EXPECT_NEAR(poses.T_world_segment[4].translation.x(), 4, 0.01);
  EXPECT_NEAR(poses.T_world_segment[1].translation.x(), 1.1, 1e-9);
  EXPECT_EQ(metrics.edges[0].kind, EdgeKind::sequential);
  EXPECT_EQ(metrics.edges[3].kind, EdgeKind::loop);
  EXPECT_EQ(metrics.edges[3].status, "rejected");
  EXPECT_TRUE(context.warnings.empty());
  EXPECT_THAT(
      metrics.notes,
      testing::ElementsAre(
          "segments 1 are named by no constraint and keep their place after the one before"));
}

TEST(SolvePoseGraph, RefusesParametersThatDoNotGoTogether) {
  const Step& step = *plumb_module()->steps[0];
  EXPECT_THROW(step.parameters({{"odometry_translation_sigma", 0.1}}), Error);
  EXPECT_THROW(step.parameters({{"scale", 1.0}, {"anneal_from", 0.5}}), Error);
}

}  // namespace
}  // namespace plumb::solve_pose_graph
