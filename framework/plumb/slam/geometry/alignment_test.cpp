#include "plumb/slam/geometry/alignment.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace plumb {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 10);
  Points points;
  for (std::size_t k = 0; k < count; ++k)
    points.emplace_back(normal(random), normal(random), normal(random));
  return points;
}

Points moved(const Points& points, const Pose& pose) {
  Points result;
  for (const auto& p : points) result.push_back(pose * p);
  return result;
}

double cost(const Points& a, const Points& b, const Pose& T_b_a) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (T_b_a * a[k] - b[k]).squaredNorm();
  return sum;
}

Pose random_pose(unsigned seed) {
  const auto v = random_points(2, seed);
  return {exp_rotation(v[0]), 10 * v[1]};
}

TEST(Alignment, FindsTheMotionOfAMovedCopy) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Pose truth = random_pose(seed);
    const Points points = random_points(3 + seed, seed + 100);
    const Pose error = align(points, moved(points, truth)).inverse() * truth;
    EXPECT_LT(error.translation.norm() + angle(error), 1e-10);
  }
}

TEST(Alignment, NeverMirrorsAndIsStillBestAmongMotionsNearIt) {
  const Points points = random_points(20, 1);
  Points mirrored = points;
  for (auto& p : mirrored) p.z() = -p.z() + 0.1 * p.x();
  const Pose best = align(points, mirrored);
  EXPECT_NEAR(best.matrix().determinant(), 1, 1e-12);
  const double least = cost(points, mirrored, best);
  for (int axis = 0; axis < 6; ++axis)
    for (const double step : {-1e-3, 1e-3}) {
      Vector6d d = Vector6d::Zero();
      d[axis] = step;
      const Pose nudged = Pose(exp_rotation(d.head<3>()), d.tail<3>()) * best;
      EXPECT_GT(cost(points, mirrored, nudged), least);
    }
}

TEST(Alignment, OfPointsThatLeaveItOpenIsStillAnExactFit) {
  const Pose truth = random_pose(7);
  const Points line{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {10, 20, 30}};
  EXPECT_LT(cost(line, moved(line, truth), align(line, moved(line, truth))), 1e-18);
  const Points plane{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_LT(cost(plane, moved(plane, truth), align(plane, moved(plane, truth))), 1e-18);
  const Points one{{5, 6, 7}};
  EXPECT_LT(cost(one, moved(one, truth), align(one, moved(one, truth))), 1e-18);
  EXPECT_EQ(align({}, {}).translation, Eigen::Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace plumb
