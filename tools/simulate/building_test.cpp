#include "simulate/building.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "simulate/indoor_drive.hpp"
#include "simulate/indoor_scene.hpp"
#include "simulate/laser_2d.hpp"
#include "simulate/testing.hpp"

namespace plumb::simulate {
namespace {

double wall_length(const std::vector<Wall>& walls) {
  double sum = 0;
  for (const Wall& wall : walls) sum += (wall.b - wall.a).norm();
  return sum;
}

TEST(FloorPlan, WallsGoRoundTheUnionOfItsFloors) {
  FloorPlan plan;
  plan.open({0, 0, 4, 2});
  EXPECT_EQ(plan.walls().size(), 4u);
  EXPECT_NEAR(wall_length(plan.walls()), 12, 1e-12);
  plan.open({3, 1, 6, 5});  // an L
  EXPECT_EQ(plan.walls().size(), 8u);
  EXPECT_NEAR(wall_length(plan.walls()), 12 + 14 - 2 * (1 + 1), 1e-12);
}

TEST(FloorPlan, ADoorOpensTheWallsOnBothOfItsSides) {
  FloorPlan plan;
  plan.open({0, 0, 4, 4});
  plan.open({4.2, 0, 8, 4});
  const double closed = wall_length(plan.walls());
  plan.open({3.9, 1, 4.3, 2});
  EXPECT_NEAR(wall_length(plan.walls()), closed - 2 * 1 + 2 * 0.2, 1e-9);
  EXPECT_TRUE(plan.is_floor({4.1, 1.5}));
  EXPECT_FALSE(plan.is_floor({4.1, 2.5}));
}

TEST(FloorPlan, APillarStandsOnTheFloorWithItsFourSides) {
  FloorPlan plan;
  plan.open({0, 0, 4, 4});
  plan.fill({1, 1, 1.5, 1.25});
  EXPECT_NEAR(wall_length(plan.walls()), 16 + 1.5, 1e-12);
  EXPECT_FALSE(plan.is_floor({1.2, 1.1}));
  EXPECT_NEAR(clearance(plan.walls(), {2.5, 1.1}), 1, 1e-12);
}

TEST(Building, TheWayStaysClearOfWallsAndComesBackToItsStart) {
  for (const std::string& name : indoor_names())
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const double length = seed % 2 == 0 ? 36 : 14;
      const Building building = build({name, length, 5, 4, seed});
      const IndoorDrive drive = drive_indoors(building.way, {0.2, 0.1, 1, seed});
      double least = 9;
      for (const PlanarPose& pose : drive.poses)
        least = std::min(least, clearance(building.walls, {pose.x, pose.y}));
      EXPECT_GT(least, 0.35) << name << " seed " << seed;
      EXPECT_EQ(building.way.front(), Eigen::Vector2d(0, 0));
      EXPECT_EQ(building.way.back(), Eigen::Vector2d(4, 0));
    }
}

TEST(Building, ItsSeedPicksWhatStandsOnTheWalls) {
  for (const std::string& name : indoor_names()) {
    EXPECT_EQ(build({name, 30, 5, 8, 3}).walls, build({name, 30, 5, 8, 3}).walls);
    EXPECT_NE(build({name, 30, 5, 8, 3}).walls, build({name, 30, 5, 8, 4}).walls);
  }
}

TEST(Building, TheScannerNeverLooksOutOfABuilding) {
  for (const std::string& name : indoor_names()) {
    const Building building = build({name, 30, 5, 8, 2});
    const Laser2d laser({6.283185307179586, 720, 500, 0}, 1);
    for (const PlanarPose& pose : drive_indoors(building.way, {0.2, 0.1, 0.2, 1}).poses)
      for (const double range : laser.exact(building.walls, pose)) EXPECT_LT(range, 100);
  }
}

/// The greatest difference of ranges seen at two poses.
double difference(const Building& building, const PlanarPose& a, const PlanarPose& b) {
  const Laser2d laser({4.71238898038469, 541, 10, 0}, 1);
  const std::vector<double> one = laser.exact(building.walls, a),
                            other = laser.exact(building.walls, b);
  double greatest = 0;
  for (std::size_t k = 0; k < one.size(); ++k)
    greatest = std::max(greatest, std::abs(one[k] - other[k]));
  return greatest;
}

TEST(Building, CorridorsThatLookAlikeGiveEqualRangesAtEqualPlaces) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Building building = build({"lookalike", 24, 5, 8, seed});
    for (double s = 1.37; s < 15; s += 1.13) {
      const PlanarPose first{s, 0.05, 0.02};
      const PlanarPose turned{16 - s, 5 - 0.05, 0.02 + std::numbers::pi};
      const PlanarPose third{s, 10.05, 0.02};
      EXPECT_LT(difference(building, first, third), 1e-6) << "seed " << seed << " at " << s;
      EXPECT_LT(difference(building, first, turned), 1e-6) << "seed " << seed << " at " << s;
      EXPECT_GT(difference(building, first, {s + 0.5, 0.05, 0.02}), 0.05);
    }
  }
}

TEST(Building, TheLongCorridorsOfTheRingLookAlikeButForOneRoom) {
  const Building building = build({"corridor", 36, 5, 8, 1});
  EXPECT_LT(difference(building, {0, 0, 0}, {28, 18, std::numbers::pi}), 1e-6);
  EXPECT_GT(difference(building, {14, 0, 0}, {14, 18, std::numbers::pi}), 1);
}

TEST(Building, RefusesANameThatIsNone) {
  EXPECT_THAT(refusal([] {
                build({"corridr", 36, 5, 8, 1});
              }),
              testing::HasSubstr("did you mean 'corridor'?"));
}

}  // namespace
}  // namespace plumb::simulate
