#include "scan_context.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include "poles_testing.hpp"

namespace plumb::loops_scan_context {
namespace {

ContextOptions small(std::uint32_t rings, std::uint32_t sectors, double max_range) {
  ContextOptions options;
  options.rings = rings;
  options.sectors = sectors;
  options.max_range = max_range;
  return options;
}

TEST(ScanContext, HoldsTheGreatestHeightOfEachRingAndSector) {
  Cloud cloud;  // four sectors, from -x by -y and x to y; two rings of 10 m; the ground at -2
  cloud.add({-5, -1, 1});                                      // sector 0, ring 0
  cloud.add({-6, -1, 2});                                      // the same, higher
  cloud.add({-15, -1, 1});                                     // sector 0, ring 1
  cloud.add({5, -1, -1});                                      // sector 1, ring 0
  cloud.add({1, 5, -7});                                       // below ground
  cloud.add({50, 1, 9});                                       // too far
  cloud.add({5, 1, std::numeric_limits<float>::quiet_NaN()});  // no number
  const ScanContext context = scan_context(cloud, Pose(), small(2, 4, 20));
  EXPECT_THAT(context.filled, testing::ElementsAre(true, true, false, false));
  EXPECT_NEAR(context.columns(0, 0), 0.8, 1e-6) << "4 and 3 m, scaled to length 1";
  EXPECT_NEAR(context.columns(1, 0), 0.6, 1e-6);
  EXPECT_NEAR(context.columns(0, 1), 1, 1e-6);
  EXPECT_TRUE(context.columns.rightCols(2).isZero(0));
  EXPECT_NEAR(context.ring_key(0), 0.75, 1e-6) << "what lies on the ground is seen, too";
  EXPECT_NEAR(context.ring_key(1), 0.25, 1e-6);
}

TEST(ScanContext, IsLevelHoweverTheSensorIsTilted) {
  const Cloud world = poles(2);
  const Pose upright = standing(100, 3, 0.3),
             tilted(upright.rotation * exp_rotation({0.4, -0.2, 0}), upright.translation);
  const ScanContext a = scan_context(seen_from(world, upright).cloud, upright, small(20, 60, 40)),
                    b = scan_context(seen_from(world, tilted).cloud, tilted, small(20, 60, 40));
  EXPECT_GT(similarity(a, b), 0.98);
  const ScanContext ignored =
      scan_context(seen_from(world, tilted).cloud, upright, small(20, 60, 40));
  EXPECT_LT(similarity(a, ignored), 0.9) << "that is what the poses are for";
}

TEST(Similarity, IsOneUnderATurnByWholeSectors) {
  const Cloud world = poles(3);
  const ContextOptions options = small(20, 60, 40);
  const Pose here = standing(100, 0, 0);
  const ScanContext a = scan_context(seen_from(world, here).cloud, Pose(), options);
  for (const int sectors : {1, 17, 59}) {
    const Pose turned = standing(100, 0, sectors * 2 * std::numbers::pi / 60);
    const ScanContext b = scan_context(seen_from(world, turned).cloud, Pose(), options);
    EXPECT_GT(similarity(a, b), 0.97) << sectors;
    EXPECT_LT((a.ring_key - b.ring_key).norm(), 0.05f) << sectors;
  }
  EXPECT_NEAR(similarity(a, a), 1, 1e-5);
}

/// Straight from [Kim2018], eq. 6 and 7, in double.
double judge(const ScanContext& a, const ScanContext& b) {
  const Eigen::MatrixXd of_a = a.columns.cast<double>(), of_b = b.columns.cast<double>();
  double best = 0;
  for (Eigen::Index turn = 0; turn < of_a.cols(); ++turn) {
    double sum = 0, counted = 0;
    for (Eigen::Index s = 0; s < of_a.cols(); ++s) {
      const auto x = of_a.col(s), y = of_b.col((s + turn) % of_a.cols());
      if (x.isZero(0) && y.isZero(0)) continue;
      counted += 1;
      if (!x.isZero(0) && !y.isZero(0)) sum += x.dot(y) / (x.norm() * y.norm());
    }
    best = std::max(best, sum / counted);
  }
  return best;
}

TEST(Similarity, IsThatOfThePaper) {
  const Cloud world = poles(4);
  for (int k = 0; k < 5; ++k) {
    const Pose here = standing(20 * k, 0, 0.1 * k), there = standing(20 * k + 3, 2, 2);
    const ScanContext a = scan_context(seen_from(world, here).cloud, here, small(20, 60, 40)),
                      b = scan_context(seen_from(world, there).cloud, there, small(20, 60, 40));
    EXPECT_NEAR(similarity(a, b), judge(a, b), 1e-5);
    EXPECT_NEAR(similarity(b, a), judge(a, b), 1e-5);
  }
}

TEST(Similarity, OfEmptyContextsIsZero) {
  const ContextOptions options = small(4, 8, 40);
  const ScanContext empty = scan_context(Cloud(), Pose(), options);
  EXPECT_EQ(similarity(empty, empty), 0);
  const ScanContext full = scan_context(poles(5), standing(-100, 0, 0), options);
  EXPECT_EQ(similarity(empty, full), 0);
}

}  // namespace
}  // namespace plumb::loops_scan_context
