#include "map_error.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/step.hpp"
#include "plumb/slam/types.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::measure_map_error {
namespace {

using parallel::in_order;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Wall> some_walls(std::size_t count) {
  std::vector<Wall> walls;
  Random random(2);
  const auto at = [&] { return Eigen::Vector2d(50 * random.uniform(), 20 * random.uniform()); };
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d a = at();
    walls.push_back({a, k % 5 == 0 ? a : k % 3 ? Eigen::Vector2d(a + 0.1 * at()) : at()});
  }
  return walls;
}

TEST(WallTree, FindsTheNearestWallAsLookingAtAllDoes) {
  for (const std::size_t count : {1, 4, 5, 9, 300}) {
    const auto walls = some_walls(count);
    const WallTree tree(walls);
    Random random(9);
    for (int k = 0; k < 500; ++k) {
      const Eigen::Vector2d p(70 * random.uniform() - 10, 40 * random.uniform() - 10);
      double best = 1e9;
      for (const auto& wall : walls) best = std::min(best, distance(wall, p));
      EXPECT_EQ(tree.distance_to(p), best);
    }
  }
}

TEST(Distance, IsToTheSegmentAndNotToItsLine) {
  const Wall wall{{1, 1}, {3, 1}};
  EXPECT_EQ(distance(wall, {2, 3}), 2);
  EXPECT_EQ(distance(wall, {0, 1}), 1);
  EXPECT_EQ(distance(wall, {6, 5}), 5);
}

/// A map with occupied cells along y = `y`, x from 0 to 4 m, 0.1 m cells; everything else is free.
GridMap wall_map(double y) {
  GridMap map;
  map.resolution = 0.1;
  map.origin = {-1, -1};
  map.columns = 60;
  map.rows = 40;
  map.log_odds.assign(60 * 40, -1);
  const auto row = static_cast<std::size_t>(std::lround((y + 1) * 10 - 0.5));
  for (std::size_t c = 10; c < 50; ++c) map.log_odds[row * 60 + c] = 2;
  return map;
}

TEST(MapError, IsTheDistanceOfOccupiedCellsFromTheWalls) {
  const std::vector<Wall> walls = {{{0, 0.5}, {4, 0.5}}};
  auto map = wall_map(0.55);
  auto error = map_error(map, walls, {}, 0.5f, 0.1, in_order);
  EXPECT_EQ(error.occupied, 40u);
  EXPECT_NEAR(error.mean, 0.05, 1e-9);
  EXPECT_NEAR(error.rms, 0.05, 1e-9);
  EXPECT_NEAR(error.accuracy, 1, 1e-9);
  EXPECT_NEAR(error.coverage, 1, 1e-9);
  map.log_odds[(10 + 25) * 60 + 30] = 3;  // one false cell at y = 2.55
  error = map_error(map, walls, {}, 0.5f, 0.1, in_order);
  EXPECT_NEAR(error.largest, 2.05, 1e-9);
  EXPECT_NEAR(error.percentile_99, 2.05, 1e-9);  // of 41 cells
  EXPECT_NEAR(error.accuracy, 40.0 / 41, 1e-9);
}

TEST(MapError, CountsWallsThatTheMapLacksInCoverageOnly) {
  const auto error = map_error(wall_map(0.55), {{{0, 0.55}, {4, 0.55}}, {{0, 2}, {12, 2}}}, {},
                               0.5f, 0.1, in_order);
  EXPECT_NEAR(error.mean, 0, 1e-9);
  EXPECT_NEAR(error.coverage, 0.25, 1e-2);
}

Trajectory walk() {
  Trajectory t;
  for (int k = 0; k < 30; ++k) {
    t.stamps.push_back(k);
    t.T_world_frame.push_back({exp_rotation({0, 0, 0.1 * k}), {0.1 * k, 0.02 * k * k, 0}});
  }
  return t;
}

TEST(PlanarAlignment, FindsTheMotionOfAPathOfALineAndOfAPlace) {
  const Pose motion(exp_rotation({0, 0, 2.5}), {7, -3, 0});
  for (const double length : {1.0, 0.0}) {
    for (const double bend : {1.0, 0.0}) {
      PosePairs pairs;
      for (const Pose& pose : walk().T_world_frame) {
        Pose at = pose;
        at.translation = {length * at.translation.x(), length * bend * at.translation.y(), 0};
        pairs.estimate.push_back(at);
        pairs.truth.push_back(motion * at);
      }
      const PlanarPose found = planar_alignment(pairs);
      EXPECT_NEAR(std::remainder(found.yaw - 2.5, 2 * std::numbers::pi), 0, 1e-9);
      EXPECT_LT((Eigen::Vector2d(found.x, found.y) - Eigen::Vector2d(7, -3)).norm(), 1e-9);
    }
  }
}

TEST(MeasureMapError, AlignsTheMapWithThePlanByTheTrajectory) {
  const io::TestFolder folder;
  const Pose T_plan_map(exp_rotation({0, 0, 0.7}), {100, 50, 0});
  Trajectory truth = walk();
  for (Pose& pose : truth.T_world_frame) pose = T_plan_map * pose;
  const auto a = T_plan_map * Eigen::Vector3d(0, 0.55, 0),
             b = T_plan_map * Eigen::Vector3d(4, 0.55, 0);
  std::string plan = "# one wall\n";
  for (const double v : {a.x(), a.y(), b.x(), b.y()}) plan += std::to_string(v) + " ";
  StepUnderTest step(*plumb_module());
  step.with("map", wall_map(0.55)).with("trajectory", walk());
  step.set("plan", folder.write("plan.txt", plan).string())
      .set("truth", folder.write("truth.tum", tum_text(truth)).string());
  TestContext context;
  const auto metrics = step.run<Metrics>("metrics", context);
  ASSERT_EQ(metrics.numbers.size(), 7u);
  EXPECT_EQ(metrics.numbers[0].name, "mean");
  EXPECT_LT(metrics.numbers[2].value, 1e-5);       // largest
  EXPECT_NEAR(metrics.numbers[5].value, 1, 1e-9);  // coverage
}

TEST(MeasureMapError, SaysThatThereIsNoPlanOrNoWall) {
  TestContext context;
  EXPECT_THAT(StepUnderTest(*plumb_module())
                  .with("map", wall_map(0.55))
                  .run<Metrics>("metrics", context)
                  .notes,
              ElementsAre(HasSubstr("no plan was given")));
  const io::TestFolder folder;
  auto empty = wall_map(0.55);
  empty.log_odds.assign(empty.log_odds.size(), 0);
  EXPECT_THAT(StepUnderTest(*plumb_module())
                  .with("map", empty)
                  .set("plan", folder.write("p", "0 0 1 1\n").string())
                  .run<Metrics>("metrics", context)
                  .notes,
              ElementsAre(HasSubstr("no occupied cell")));
}

TEST(MeasureMapError, RefusesATruthThatDoesNotFitAndAPlanThatIsNone) {
  const io::TestFolder folder;
  const auto plan = folder.write("plan.txt", "0 0 1 1\n").string();
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("map", wall_map(0.55))
      .set("plan", plan)
      .set("truth", folder.write("t.tum", "500 0 0 0 0 0 0 1\n").string());
  EXPECT_THAT(io::refusal([&] { step.run<Metrics>("metrics", context); }),
              HasSubstr("no trajectory to align with it"));
  step.with("trajectory", walk());
  EXPECT_THAT(io::refusal([&] { step.run<Metrics>("metrics", context); }),
              HasSubstr("no pose has the stamp"));
  const auto said = [&](const std::string& text) {
    return io::refusal([&] { read_plan(folder.write("p", text)); });
  };
  EXPECT_THAT(said("0 0 1 1\n0 0 1\n"),
              HasSubstr("p:2: expected a wall 'x1 y1 x2 y2', found 3 numbers"));
  EXPECT_THAT(said("0 0 1 nan\n"), HasSubstr("found 'nan'"));
  EXPECT_THAT(said("# none\n"), HasSubstr("holds no wall"));
}

}  // namespace
}  // namespace plumb::measure_map_error
