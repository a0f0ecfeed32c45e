#include "shared/point_pairs/rigid_fit.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numeric>

#include "plumb/data/random.hpp"

namespace plumb::point_pairs {
namespace {

using testing::ElementsAre;

const Pose motion(exp_rotation({0.1, -0.2, 0.9}), {5, -3, 1});

struct Pairs {
  std::vector<Eigen::Vector3f> from, to;
  std::vector<std::uint32_t> all() const {
    std::vector<std::uint32_t> indices(from.size());
    std::iota(indices.begin(), indices.end(), 0);
    return indices;
  }
};

/// Points in a box of 60 m, `height` of it along z, and where `motion` takes them, to within
/// `noise` [m] on each axis.
Pairs moved_points(int count, double height, double noise, std::uint64_t seed) {
  Random random(seed);
  const auto uniform = [&](double half) { return half * (2 * random.uniform() - 1); };
  Pairs pairs;
  for (int k = 0; k < count; ++k) {
    const double x = uniform(30), y = uniform(30), z = uniform(30 * height);
    const double u = uniform(noise), v = uniform(noise), w = uniform(noise);
    const Eigen::Vector3d from(x, y, z), off(u, v, w);
    pairs.from.push_back(from.cast<float>());
    pairs.to.push_back((motion * from + off).cast<float>());
  }
  return pairs;
}

TEST(RigidFit, FitsAsUmeyamaDoes) {
  const Pairs pairs = moved_points(12, 1, 0.05, 8);
  Eigen::Matrix3Xd from(3, 12), to(3, 12);
  for (int k = 0; k < 12; ++k) {
    from.col(k) = pairs.from[k].cast<double>();
    to.col(k) = pairs.to[k].cast<double>();
  }
  const Eigen::Matrix4d judge = Eigen::umeyama(from, to, false);
  const Pose fitted = rigid_fit(pairs.from, pairs.to, pairs.all());
  EXPECT_LT((fitted.matrix() - judge.topLeftCorner<3, 3>()).norm(), 1e-12);
  EXPECT_LT((fitted.translation - judge.topRightCorner<3, 1>()).norm(), 1e-11);
}

TEST(RigidFit, IsARotationOfPointsInAPlaneAndNoReflection) {
  const Pairs pairs = moved_points(9, 0, 0, 4);
  const Pose error = motion.inverse() * rigid_fit(pairs.from, pairs.to, pairs.all());
  EXPECT_LT(angle(error), 1e-5);
}

TEST(RigidFit, SeesThePairsThatAreNamedAlone) {
  Pairs pairs = moved_points(6, 1, 0, 2);
  pairs.to[1] += Eigen::Vector3f(20, 0, 0);
  const std::vector<std::uint32_t> right = {0, 2, 3, 4, 5};
  const Pose error = motion.inverse() * rigid_fit(pairs.from, pairs.to, right);
  EXPECT_LT(error.translation.norm(), 1e-4);
  EXPECT_LT(angle(error), 1e-5);
}

TEST(RigidFit, CountsAPairAsOftenAsItsWeightSays) {
  const Pairs pairs = moved_points(8, 1, 0.5, 6);
  const std::vector<std::uint32_t> repeated = {0, 1, 1, 2, 2, 2, 3, 5}, once = {0, 1, 2, 3, 4, 5};
  const std::vector<double> weights = {1, 2, 3, 1, 0, 1};
  const Pose judge = rigid_fit(pairs.from, pairs.to, repeated),
             weighted = rigid_fit(pairs.from, pairs.to, once, weights);
  EXPECT_LT((weighted.translation - judge.translation).norm(), 1e-11);
  EXPECT_LT(angle(judge.inverse() * weighted), 1e-12);
}

TEST(Agreeing, KeepsPairsUpToAndWithTheLimit) {
  std::vector<Eigen::Vector3f> from(6, Eigen::Vector3f(0, 7, 0)), to;
  for (int k = 0; k < 6; ++k) to.push_back({static_cast<float>(k), 7, 0});
  EXPECT_THAT(agreeing(from, to, Pose(), 3), ElementsAre(0, 1, 2, 3));
  const Pose two_ahead(Eigen::Quaterniond::Identity(), {2, 0, 0});
  EXPECT_THAT(agreeing(from, to, two_ahead, 1), ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace plumb::point_pairs
