#include "shared/planar/correlative_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace plumb::planar {
namespace {

struct Points {
  std::vector<float> x, y;
};

/// An L-shaped room with a pillar, seen as points every 5 cm.
Points room() {
  Points points;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    const int n = static_cast<int>(std::hypot(x1 - x0, y1 - y0) / 0.05);
    for (int k = 0; k <= n; ++k) {
      points.x.push_back(static_cast<float>(x0 + (x1 - x0) * k / n));
      points.y.push_back(static_cast<float>(y0 + (y1 - y0) * k / n));
    }
  };
  wall(-3, -2, 5, -2), wall(5, -2, 5, 1), wall(5, 1, 1, 1), wall(1, 1, 1, 4), wall(1, 4, -3, 4),
      wall(-3, 4, -3, -2);
  wall(-1, 1, -0.6, 1), wall(-0.6, 1, -0.6, 1.3);
  return points;
}

Points seen_from(const Points& world, const PlanarPose& T_world_sensor) {
  Points seen;
  const PlanarPose back = T_world_sensor.inverse();
  const double c = std::cos(back.yaw), s = std::sin(back.yaw);
  for (std::size_t k = 0; k < world.x.size(); k += 3) {
    seen.x.push_back(static_cast<float>(back.x + c * world.x[k] - s * world.y[k]));
    seen.y.push_back(static_cast<float>(back.y + s * world.x[k] + c * world.y[k]));
  }
  return seen;
}

TEST(LikelihoodField, FallsAsAGaussianWithTheDistance) {
  const LikelihoodField field({0.025f}, {0.025f}, 0.05, 0.1, 0.5, 1);
  for (const double d : {0.0, 0.1, 0.2}) {
    const auto cell = field.cell(0.025 + d, 0.025);
    EXPECT_NEAR(field.value(0, cell.x(), cell.y()), 255 * std::exp(-0.5 * d * d / 0.01), 12)
        << d;  // a quarter cell off at most
  }
  EXPECT_EQ(field.value(0, -1000, 0), 0);
}

TEST(LikelihoodField, EachLevelHoldsTheLargestValueOfItsSquare) {
  const Points points = room();
  const LikelihoodField field(points.x, points.y, 0.1, 0.1, 0.3, 4);
  for (int level = 1; level < 4; ++level)
    for (int row = -20; row < 70; row += 3)
      for (int column = -20; column < 90; column += 3) {
        int largest = 0;
        for (int r = row; r < row + (1 << level); ++r)
          for (int c = column; c < column + (1 << level); ++c)
            largest = std::max<int>(largest, field.value(0, c, r));
        ASSERT_EQ(field.value(level, column, row), largest) << level << ' ' << column << ' ' << row;
      }
}

TEST(LikelihoodField, RefusesWorldsThatDoNotFit) {
  EXPECT_THROW(LikelihoodField({0, 1e6}, {0, 1e6}, 0.05, 0.1, 0.5, 1), std::length_error);
}

TEST(CorrelativeSearch, FindsWhatTryingEveryPoseFinds) {
  const Points world = room();
  const LikelihoodField field(world.x, world.y, 0.1, 0.1, 0.3, 5);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-0.4, 0.4);
  for (int round = 0; round < 5; ++round) {
    const PlanarPose truth{off(random), off(random), off(random)};
    const Points seen = seen_from(world, truth);
    const SearchWindow window{{0.05, -0.02, 0.01}, 0.5, 0.4, 0.4};
    const double step = 0.05;
    double best = -1;
    for (int n = -8; n <= 8; ++n)
      for (int r = -4; r <= 4; ++r)
        for (int c = -5; c <= 5; ++c)
          best = std::max(best, score_of(field, seen.x, seen.y,
                                         {window.centre.x + 0.1 * c, window.centre.y + 0.1 * r,
                                          window.centre.yaw + step * n}));
    const auto peak = best_pose(field, seen.x, seen.y, window, step, 0);
    ASSERT_TRUE(peak);
    EXPECT_NEAR(peak->score, best,
                0.01);  // cells are counted from the window's corner there, from the pose here
    EXPECT_NEAR(peak->pose.x, truth.x, 0.1);
    EXPECT_NEAR(peak->pose.y, truth.y, 0.1);
  }
}

TEST(CorrelativeSearch, FindsNothingBelowTheLeastScoreAndNothingExcluded) {
  const Points world = room();
  const LikelihoodField field(world.x, world.y, 0.1, 0.1, 0.3, 5);
  const Points seen = seen_from(world, {0.2, 0.1, 0.1});
  const SearchWindow window{{}, 0.5, 0.5, 0.3};
  const auto peak = best_pose(field, seen.x, seen.y, window, 0.02, 0);
  ASSERT_TRUE(peak);
  EXPECT_FALSE(best_pose(field, seen.x, seen.y, window, 0.02, peak->score + 1e-3));
  const auto other =
      best_pose(field, seen.x, seen.y, window, 0.02, 0, Excluded{peak->pose, 0.35, 0.5});
  ASSERT_TRUE(other);
  EXPECT_LT(other->score, peak->score);
  EXPECT_GE(std::hypot(other->pose.x - peak->pose.x, other->pose.y - peak->pose.y), 0.35);
}

TEST(CorrelativeSearch, ComesBetweenTheCells) {
  const Points world = room();
  const LikelihoodField field(world.x, world.y, 0.05, 0.08, 0.3, 4);
  const PlanarPose truth{0.118, -0.073, 0.031};
  const Points seen = seen_from(world, truth);
  const double step = yaw_step_for(seen.x, seen.y, 0.05);
  const auto peak = best_pose(field, seen.x, seen.y, {{}, 0.3, 0.3, 0.1}, step, 0);
  ASSERT_TRUE(peak);
  const PlanarPose between = between_cells(field, seen.x, seen.y, peak->pose, step);
  EXPECT_LT(std::hypot(between.x - truth.x, between.y - truth.y), 0.015);
  EXPECT_NEAR(between.yaw, truth.yaw, 0.004);
}

TEST(CorrelativeSearch, HasNothingToSayWithoutPoints) {
  const LikelihoodField field({}, {}, 0.1, 0.1, 0.3, 3);
  EXPECT_FALSE(best_pose(field, {}, {}, {}, 0.1, 0));
  EXPECT_FALSE(best_pose(field, {1.f}, {1.f}, {}, 0.1, 0));
}

}  // namespace
}  // namespace plumb::planar
