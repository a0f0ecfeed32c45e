#include "shared/planar/icp.hpp"

#include <gtest/gtest.h>

#include "shared/planar/room_testing.hpp"

namespace plumb::planar {
namespace {

struct Points {
  std::vector<float> x, y, z, nx, ny;
  void add(const Eigen::Vector3f& p) { x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z()); }
  std::size_t size() const { return x.size(); }
};

Points scan(const PlanarPose& at, int beams, double noise, unsigned seed) {
  return room_scan<Points>(at, beams, noise, seed);
}

TEST(PlanarIcp, FindsTheMotionBetweenTwoScans) {
  const PlanarPose a{0, 0, 0.2}, b{0.12, 0.05, 0.26};
  const Points target = scan(a, 720, 0.005, 1), source = scan(b, 360, 0.005, 2);
  const SearchTree tree(target);
  const PlanarPose truth = a.inverse() * b;
  const auto found = align(target, tree, source, {}, {});
  EXPECT_LT(off(found.T, truth), 0.02);
  EXPECT_NEAR(found.T.yaw, truth.yaw, 0.005);
  EXPECT_GT(found.overlap, 0.95);
}

TEST(PlanarIcp, StopsOncePairsComeNoNearerInFewerIterationsAndHardlyFartherOff) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-0.5, 0.5), step(-0.08, 0.08);
  double usual = 0, adaptive = 0, usual_off = 0, adaptive_off = 0;
  for (int round = 0; round < 30; ++round) {
    const PlanarPose a{at(random), at(random), at(random)},
        motion{step(random), step(random), 0.5 * step(random)};
    const Points target = scan(a, 360, 0.01, 10 + round),
                 source = scan(a * motion, 360, 0.01, 100 + round);
    const SearchTree tree(target);
    IcpOptions options;
    const auto icp = align(target, tree, source, {}, options);
    options.stop = Stop::ratio;
    const auto ia = align(target, tree, source, {}, options);
    usual += icp.iterations, adaptive += ia.iterations;
    usual_off += off(icp.T, motion) / 30, adaptive_off += off(ia.T, motion) / 30;
  }
  EXPECT_LT(adaptive, 0.5 * usual);
  EXPECT_LT(adaptive_off, usual_off + 0.005);
}

TEST(PlanarIcp, AlongLinesASourceMayLieBetweenTheTargetsPoints) {
  const PlanarPose a{}, b{0.04, -0.03, 0.02};
  Points target = scan(a, 180, 0, 1);
  const Points source = scan(b, 181, 0, 2);
  // Normals of the walls, all of which lie along x or y.
  for (std::size_t k = 0; k < target.size(); ++k) {
    const float x = target.x[k], y = target.y[k];
    const bool upright =
        std::min({std::abs(x + 3), std::abs(x - 5), std::abs(x - 1.5f), std::abs(x + 0.5f)}) <
        std::min({std::abs(y + 2), std::abs(y - 1), std::abs(y - 4), std::abs(y - 2)});
    target.nx.push_back(upright ? 1 : 0), target.ny.push_back(upright ? 0 : 1);
  }
  const SearchTree tree(target);
  IcpOptions options;
  options.metric = Metric::line;
  const auto found = align(target, tree, source, {}, options);
  EXPECT_LT(off(found.T, b), 0.002);
  EXPECT_NEAR(found.T.yaw, b.yaw, 0.001);
}

TEST(PlanarIcp, KnowsThatACorridorSaysNothingAboutTheWayAlongIt) {
  Points corridor;
  for (int k = 0; k <= 200; ++k)
    for (const float y : {-1.f, 1.f}) {
      corridor.add({-5 + 0.05f * k, y, 0});
      corridor.nx.push_back(0), corridor.ny.push_back(1);
    }
  const SearchTree tree(corridor);
  IcpOptions options;
  options.metric = Metric::line;
  options.start_sigma = 0.02;
  const auto found = align(corridor, tree, corridor, {0.3, 0.05, 0}, options);
  EXPECT_NEAR(found.T.y, 0, 4e-3);  // the hold draws it back by 0.05 m * 2500 / (2500 + 44700)
  EXPECT_NEAR(found.T.x, 0.3, 1e-6);
  EXPECT_NEAR(found.information(0, 0), 2500, 1);  // what the hold says
  EXPECT_GT(found.information(1, 1), 40000);
}

TEST(PlanarIcp, LeavesThePoseWhereThereIsNothingToPair) {
  Points near, far;
  for (int k = 0; k < 10; ++k) near.add({0.1f * k, 0, 0}), far.add({100 + 0.1f * k, 0, 0});
  const SearchTree tree(near);
  const auto found = align(near, tree, far, {1, 2, 0.5}, {});
  EXPECT_EQ(found.T.x, 1);
  EXPECT_EQ(found.T.yaw, 0.5);
  EXPECT_EQ(found.overlap, 0);
}

TEST(PlanarIcp, OnlyJudgesTheStartWithoutIterations) {
  const PlanarPose b{0.02, 0.01, 0.01};
  const Points target = scan({}, 720, 0.005, 1), source = scan(b, 360, 0.005, 2);
  const SearchTree tree(target);
  IcpOptions options;
  options.max_iterations = 0;
  const auto found = align(target, tree, source, b, options);
  EXPECT_EQ(off(found.T, b), 0);
  EXPECT_EQ(found.T.yaw, b.yaw);
  EXPECT_EQ(found.iterations, 0u);
  EXPECT_GT(found.overlap, 0.95);
  EXPECT_LT(found.mae, 0.02);
  EXPECT_GT(found.information(0, 0), 1000);
}

}  // namespace
}  // namespace plumb::planar
