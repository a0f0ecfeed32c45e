#include "pose_graph.hpp"

#include <gmock/gmock.h>

#include "graph_testing.hpp"
#include "plumb/data/archive.hpp"
#include "plumb/data/error.hpp"

namespace plumb::solve_pose_graph {
namespace {

GraphResult solve(const TestGraph& g, const GraphOptions& options, const Poses* start = nullptr) {
  return solve_pose_graph(start ? *start : g.drifted, g.matched(), nullptr, options, in_order);
}

GraphOptions robust() {
  GraphOptions o;
  o.loss = Loss::geman_mcclure;
  o.anneal_from = 10;
  o.scale = 0.5;
  return o;
}

TEST(PoseGraph, BringsADriftedRunBackToTheTruth) {
  const auto g = circle(30, 2, 1);
  ASSERT_GT(ate(g.drifted, g.truth), 1);
  for (const Loss loss : {Loss::none, Loss::huber, Loss::cauchy, Loss::geman_mcclure}) {
    auto options = robust();
    options.loss = loss;
    const auto result = solve(g, options);
    EXPECT_LT(ate(result.poses, g.truth), 0.05);
    EXPECT_EQ(result.metrics.numbers[0].name, "residual");
    EXPECT_NEAR(result.metrics.numbers[0].value, 0.05 * std::sqrt(3), 0.01);
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_THAT(result.metrics.notes, testing::IsEmpty());
  }
}

TEST(PoseGraph, DoesSoWithPlanesToo) {
  auto g = circle(30, 2, 2, 0.3);
  for (auto& m : g.matches) m.to_plane = true;
  GraphOptions options;
  options.loss = Loss::none;
  EXPECT_LT(ate(solve(g, options).poses, g.truth), 0.05);
}

TEST(PoseGraph, LeavesTheFirstPoseAndAPerfectGraphAsTheyAre) {
  const auto g = circle(20, 2, 3);
  const auto result = solve(g, robust(), &g.truth);
  EXPECT_EQ(result.poses.T_world_segment[0].translation, g.truth.T_world_segment[0].translation);
  EXPECT_LT(ate(result.poses, g.truth), 0.03);
}

/// Points every `each`-th loop edge at another segment, with pairs that agree among themselves
/// about a wrong place.
std::vector<std::size_t> plant_false_loops(TestGraph& g, std::size_t each, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::size_t> planted;
  std::size_t loops = 0;
  for (std::size_t k = 0; k < g.edges.size(); ++k) {
    if (g.edges[k].kind != EdgeKind::loop || ++loops % each != 0) continue;
    planted.push_back(k);
    Poses wrong = g.truth;
    wrong.T_world_segment[g.edges[k].i].translation +=
        Eigen::Vector3d(8, -6, 1) + gauss3(random, 4);
    g.matches[k] = pairs_of(g.edges[k], wrong, 100, 0.05, 0, random);
  }
  return planted;
}

TEST(PoseGraph, LetsGoOfPlantedFalseLoopsAndNamesThem) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    auto g = circle(30, 3, seed);
    const double clean = ate(solve(g, robust()).poses, g.truth);
    const auto planted = plant_false_loops(g, 10, seed);
    const auto result = solve(g, robust());
    EXPECT_LT(ate(result.poses, g.truth), 1.1 * clean + 1e-3) << seed;
    for (std::size_t k = 0; k < g.edges.size(); ++k) {
      const bool is_planted = std::find(planted.begin(), planted.end(), k) != planted.end();
      EXPECT_EQ(result.metrics.edges[k].status, is_planted ? "rejected" : "accepted")
          << seed << " " << k;
    }
  }
}

TEST(PoseGraph, SurvivesLoopsOfWhichHalfAreMostlyWrong) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    auto g = circle(40, 2, seed);
    plant_false_loops(g, 2, seed);
    auto options = robust();
    options.max_edge_weight = 30;
    EXPECT_LT(ate(solve(g, options).poses, g.truth), 0.15) << seed;
  }
}

TEST(PoseGraph, AnEdgesOwnLossRejectsItAsAWhole) {
  auto g = circle(30, 3, 5);
  const auto planted = plant_false_loops(g, 10, 5);
  auto options = robust();
  options.loss = Loss::huber;
  options.edge_loss = Loss::geman_mcclure;
  options.edge_scale = 0.5;
  const auto result = solve(g, options);
  EXPECT_LT(ate(result.poses, g.truth), 0.05);
  for (const auto k : planted) EXPECT_EQ(result.metrics.edges[k].status, "rejected");
}

TEST(PoseGraph, SaysPartByPartWhereItFallsApart) {
  auto g = circle(10, 1, 1);
  g.matches[4] = Matches();  // edge (4, 5)
  const auto result = solve(g, robust());
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings[0], testing::HasSubstr("2 parts (segments 0-4; 5-9)"));
  EXPECT_EQ(result.metrics.edges[4].status, "no matches");
  // The second part keeps its place after segment 4 and is right within itself.
  const Pose kept = g.drifted.relative(4, 5), now = result.poses.relative(4, 5);
  EXPECT_LT((kept.translation - now.translation).norm(), 1e-9);
  EXPECT_LT((result.poses.relative(5, 9).translation - g.truth.relative(5, 9).translation).norm(),
            0.1);
  // With the odometry's shape as a prior it is one graph.
  auto options = robust();
  options.odometry_translation_sigma = 0.1;
  options.odometry_rotation_sigma = 0.01;
  EXPECT_TRUE(solve(g, options).warnings.empty());
}

TEST(PoseGraph, TheOdometryHoldsTheShapeWhereSequentialPairsAreFewAndWrong) {
  auto g = circle(30, 2, 4, 0.2);
  std::mt19937 random(9);
  for (std::size_t k = 0; k < g.edges.size(); ++k)
    if (g.edges[k].kind == EdgeKind::sequential)
      g.matches[k] = pairs_of(g.edges[k], g.truth, 4, 2, 0, random);
  auto options = robust();
  const double without = ate(solve(g, options).poses, g.truth);
  options.odometry_translation_sigma = 0.05;
  options.odometry_rotation_sigma = 0.003;
  const double with = ate(solve(g, options).poses, g.truth);
  EXPECT_LT(with, 0.5 * without);
}

TEST(PoseGraph, GivesTheSameBytesInAnyOrderOfWork) {
  const auto g = circle(20, 2, 6);
  const auto a = solve(g, robust());
  const auto b = solve_pose_graph(g.drifted, g.matched(), nullptr, robust(), parallel::backwards);
  EXPECT_EQ(content_hash(a.poses), content_hash(b.poses));
  EXPECT_EQ(content_hash(a.metrics), content_hash(b.metrics));
}

TEST(PoseGraph, WorksAtUtmCoordinates) {
  auto g = circle(20, 2, 6);
  const auto here = solve(g, robust());
  const Pose utm(exp_rotation({0, 0, 1}), {412000, 5650000, 110});
  for (auto* poses : {&g.truth, &g.drifted})
    for (auto& pose : poses->T_world_segment) pose = utm * pose;
  const auto there = solve(g, robust());
  for (std::size_t k = 0; k < g.truth.size(); ++k)
    EXPECT_LT((there.poses.T_world_segment[k].translation -
               (utm * here.poses.T_world_segment[k]).translation)
                  .norm(),
              1e-4);
}

TEST(PoseGraph, RefusesAnEdgeToAPoseThatIsNotThere) {
  auto g = circle(5, 1, 1);
  g.edges[0].j = 17;
  EXPECT_THROW(solve(g, robust()), Error);
}

TEST(PoseGraph, RefusesPlanesWithoutNormals) {
  auto g = circle(5, 1, 1);
  g.matches[0].to_plane = true;
  g.matches[0].normal_q.clear();
  EXPECT_THROW(solve(g, robust()), Error);
}

}  // namespace
}  // namespace plumb::solve_pose_graph
