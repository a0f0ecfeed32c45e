#include "shared/pcl/registering.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "shared/pcl/street_testing.hpp"

namespace plumb::pcl {
namespace {

const Pose motion(exp_rotation({0.1, -0.2, 0.7}), {4, -2, 1});

/// Level ground with normals, 20 m wide.
Cloud ground(std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (int k = 0; k < 4000; ++k) {
    const auto x = static_cast<float>(20 * (random.uniform() - 0.5)),
               y = static_cast<float>(20 * (random.uniform() - 0.5));
    cloud.add({x, y, 0});
    cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  }
  return cloud;
}

TEST(Registering, GivesAMotionToPclAndBack) {
  const Aligned back = aligned_by(matrix_of(motion), 7, true);
  EXPECT_TRUE(back.converged);
  EXPECT_EQ(back.iterations, 7u);
  EXPECT_LT((back.T_i_j.translation - motion.translation).norm(), 1e-6);
  EXPECT_LT(angle(motion.inverse() * back.T_i_j), 1e-6);
}

TEST(Registering, TakesNoMatrixForAMotionThatIsNone) {
  Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
  matrix(0, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(aligned_by(matrix, 1, true).converged);
  EXPECT_FALSE(aligned_by(2 * Eigen::Matrix4f::Identity(), 1, true).converged);
  EXPECT_FALSE(aligned_by(Eigen::Matrix4f::Identity(), 1, false).converged);
}

TEST(Registering, JudgesByTheNearestPoints) {
  const Segment i = segment_of(street_corner(8000, 1));
  const Cloud j = moved(street_corner(4000, 2), motion.inverse());
  const auto good = judged(i, j, {motion, 5, true}, Pose(), {});
  EXPECT_TRUE(good.accepted);
  EXPECT_EQ(good.iterations, 5u);
  EXPECT_GT(good.overlap, 0.95f);
  EXPECT_LT(good.mae, 0.2f);
  EXPECT_EQ(good.pairs, static_cast<std::uint32_t>(std::lround(good.overlap * 4000)));
  const Pose off(Eigen::Quaterniond::Identity(), {100, 0, 0});
  const auto bad = judged(i, j, {off * motion, 5, true}, Pose(), {});
  EXPECT_FALSE(bad.accepted);
  EXPECT_EQ(bad.pairs, 0u);
  EXPECT_TRUE(bad.information.isZero(0));
}

TEST(Registering, KeepsTheStartWhereNothingConverged) {
  const Segment i = segment_of(street_corner(4000, 3));
  const auto result = judged(i, i.cloud, {motion, 9, false}, Pose(), {});
  EXPECT_FALSE(result.accepted);
  EXPECT_EQ(result.T_i_j.translation, Pose().translation);
  EXPECT_EQ(result.overlap, 1);
}

TEST(Registering, KnowsWhatGroundFixesAndInWhoseAxes) {
  const Cloud cloud = ground(4);
  const Segment i = segment_of(cloud);
  // j lies on its side, so that the ground's normal is its x axis.
  const Pose T(
      Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY())),
      {0, 0, 0});
  const auto result = judged(i, moved(cloud, T.inverse()), {T, 1, true}, Pose(), {});
  const Matrix6d& h = result.information;
  EXPECT_NEAR(h(0, 0), 50 / 1e-4, 1);  // 50 pairs of 1 cm
  for (const int c : {1, 2, 3}) EXPECT_LT(h(c, c), 1e-3 * h(0, 0)) << c;
  for (const int c : {4, 5}) EXPECT_GT(h(c, c), 10 * h(0, 0)) << c;
}

TEST(Registering, WithoutNormalsEachPairFixesAllDirections) {
  Cloud bare = ground(5);
  bare.nx.clear(), bare.ny.clear(), bare.nz.clear();
  const auto result = judged(segment_of(bare), bare, {Pose(), 1, true}, Pose(), {});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.information(c, c), 50 / 1e-4, 1) << c;
}

TEST(Registering, StaysInThePlaneWhereAsked) {
  const Segment i = segment_of(street_corner(4000, 6));
  const Pose tilted(exp_rotation({0.01, -0.01, 0.3}), {1, 2, 0.05});
  const auto result =
      judged(i, moved(i.cloud, tilted.inverse()), {tilted, 1, true}, Pose(), {.planar = true});
  EXPECT_TRUE(in_plane(result.T_i_j));
  EXPECT_NEAR(result.T_i_j.translation.x(), 1, 1e-9);
  for (const int c : {2, 3, 4}) EXPECT_EQ(result.information(c, c), 0) << c;
  EXPECT_GT(result.information(5, 5), 0);
}

}  // namespace
}  // namespace plumb::pcl
