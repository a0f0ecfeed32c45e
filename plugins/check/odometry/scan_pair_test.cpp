#include "scan_pair.hpp"

#include <gmock/gmock.h>

#include "divergence_testing.hpp"

namespace plumb::check_odometry {
namespace {

TEST(ScanTarget, FitsATrueMotionBestOfAll) {
  const Drive& d = drive();
  for (const std::size_t k : {0u, 10u, 20u, 30u}) {
    ScanTarget target(d.frames[k].cloud, {});
    const auto source = asked_points(d.frames[k + 3].cloud, {});
    const Pose T = d.truth.T_world_frame[k].inverse() * d.truth.T_world_frame[k + 3];
    const double right = target.misfit(source, T);
    EXPECT_LT(right, 0.25);
    for (const double factor : {0.0, 0.5, 2.0})
      EXPECT_LT(right, 0.6 * target.misfit(source, scaled(T, factor))) << k << ", " << factor;
  }
}

TEST(ScanTarget, AlignsFromAMetreAway) {
  const Drive& d = drive();
  ScanTarget target(d.frames[10].cloud, {});
  const auto source = asked_points(d.frames[12].cloud, {});
  const Pose T = d.truth.T_world_frame[10].inverse() * d.truth.T_world_frame[12];
  const Pose off = T * Pose(exp_rotation({0, 0, 2 * degree}), {0.8, 0.3, 0.1});
  const Pose error = T.inverse() * target.aligned(source, off);
  EXPECT_LT(error.translation.norm(), 0.15);
  EXPECT_LT(angle(error), 0.5 * degree);
}

TEST(ScanTarget, GivesTheFarthestMisfitWhereThereIsNothing) {
  const Drive& d = drive();
  ScanTarget target(d.frames[0].cloud, {}), empty(Cloud(), {});
  const auto source = asked_points(d.frames[1].cloud, {});
  EXPECT_EQ(target.misfit(source, Pose(Eigen::Quaterniond::Identity(), {0, 0, 500})), 1);
  EXPECT_EQ(target.misfit({}, Pose()), 1);
  EXPECT_EQ(empty.misfit(source, Pose()), 1);
  EXPECT_LE(source.size(), 500u);
  EXPECT_TRUE(asked_points(Cloud(), {}).empty());
}

}  // namespace
}  // namespace plumb::check_odometry
