#include "shared/planar/planar_pose.hpp"

#include <gtest/gtest.h>

namespace plumb::planar {
namespace {

TEST(PlanarPose, UndoesItselfAndAgreesWithPosesInSpace) {
  const PlanarPose a{1, -2, 0.7}, b{0.3, 0.4, -2.9};
  const PlanarPose none = a * a.inverse();
  EXPECT_NEAR(none.x, 0, 1e-12);
  EXPECT_NEAR(none.y, 0, 1e-12);
  EXPECT_NEAR(wrapped(none.yaw), 0, 1e-12);
  const PlanarPose through = projected(in_space(a) * in_space(b)), direct = a * b;
  EXPECT_NEAR(through.x, direct.x, 1e-12);
  EXPECT_NEAR(through.y, direct.y, 1e-12);
  EXPECT_NEAR(wrapped(through.yaw - direct.yaw), 0, 1e-12);
}

TEST(PlanarPose, MovesPointsAsThePoseInSpaceDoes) {
  const PlanarPose a{1, -2, 0.7};
  const Eigen::Vector3d in_space_too = in_space(a) * Eigen::Vector3d(3, 4, 0);
  EXPECT_LT((a * Eigen::Vector2d(3, 4) - in_space_too.head<2>()).norm(), 1e-12);
  EXPECT_NEAR(in_space_too.z(), 0, 1e-12);
}

}  // namespace
}  // namespace plumb::planar
