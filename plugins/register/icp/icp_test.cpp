#include "icp.hpp"

#include <gtest/gtest.h>

#include <random>

#include "plumb/data/registration.hpp"
#include "plumb/plugin/step_testing.hpp"

namespace plumb {
namespace {

/// A room of 8 m x 6 m with a recess, as a laser in it sees it: `beams` rays, noise [m].
Cloud scan(const PlanarPose& at, int beams, double noise, unsigned seed) {
  const double walls[][4] = {{-3, -2, 5, -2}, {5, -2, 5, 1}, {5, 1, 1.5, 1}, {1.5, 1, 1.5, 4}, {1.5, 4, -3, 4},
                             {-3, 4, -3, -2}, {-1, 2, -0.5, 2}, {-0.5, 2, -0.5, 2.4}};
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  Cloud cloud;
  for (int k = 0; k < beams; ++k) {
    const double angle = 2 * M_PI * k / beams, heading = at.yaw + angle;
    const double dx = std::cos(heading), dy = std::sin(heading);
    double nearest = 1e9;
    for (const auto& w : walls) {
      const double ex = w[2] - w[0], ey = w[3] - w[1], det = ex * dy - ey * dx;
      if (std::abs(det) < 1e-12) continue;
      const double px = w[0] - at.x, py = w[1] - at.y;
      const double range = (ex * py - ey * px) / det, along = (dx * py - dy * px) / det;
      if (range > 0 && along >= 0 && along <= 1) nearest = std::min(nearest, range);
    }
    const double range = nearest + (noise > 0 ? error(random) : 0);
    cloud.add({static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0});
  }
  return cloud;
}

double off(const PlanarPose& a, const PlanarPose& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(Icp, FindsTheMotionBetweenTwoScans) {
  const PlanarPose a{0, 0, 0.2}, b{0.12, 0.05, 0.26};
  const Cloud target = scan(a, 720, 0.005, 1), source = scan(b, 360, 0.005, 2);
  const SearchTree tree(target);
  const PlanarPose truth = a.inverse() * b;
  const auto found = lay_onto(target, tree, source, {}, {});
  EXPECT_LT(off(found.T, truth), 0.02);
  EXPECT_NEAR(found.T.yaw, truth.yaw, 0.005);
  EXPECT_GT(found.overlap, 0.95);
}

TEST(Icp, StopsOncePairsComeNoNearerInFewerIterationsAndHardlyFartherOff) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-0.5, 0.5), step(-0.08, 0.08);
  double usual = 0, adaptive = 0, usual_off = 0, adaptive_off = 0;
  for (int round = 0; round < 30; ++round) {
    const PlanarPose a{at(random), at(random), at(random)}, motion{step(random), step(random), 0.5 * step(random)};
    const Cloud target = scan(a, 360, 0.01, 10 + round), source = scan(a * motion, 360, 0.01, 100 + round);
    const SearchTree tree(target);
    IcpOptions options;
    const auto icp = lay_onto(target, tree, source, {}, options);
    options.stop = Stop::ratio;
    const auto ia = lay_onto(target, tree, source, {}, options);
    usual += icp.iterations, adaptive += ia.iterations;
    usual_off += off(icp.T, motion) / 30, adaptive_off += off(ia.T, motion) / 30;
  }
  EXPECT_LT(adaptive, 0.5 * usual);
  EXPECT_LT(adaptive_off, usual_off + 0.005);
}

TEST(Icp, AlongLinesASourceMayLieBetweenTheTargetsPoints) {
  const PlanarPose a{}, b{0.04, -0.03, 0.02};
  Cloud target = scan(a, 180, 0, 1);
  const Cloud source = scan(b, 181, 0, 2);
  // Normals of the walls, all of which lie along x or y.
  for (std::size_t k = 0; k < target.size(); ++k) {
    const float x = target.x[k], y = target.y[k];
    const bool upright = std::min({std::abs(x + 3), std::abs(x - 5), std::abs(x - 1.5f), std::abs(x + 0.5f)}) <
                         std::min({std::abs(y + 2), std::abs(y - 1), std::abs(y - 4), std::abs(y - 2)});
    target.nx.push_back(upright ? 1 : 0), target.ny.push_back(upright ? 0 : 1), target.nz.push_back(0);
  }
  const SearchTree tree(target);
  IcpOptions options;
  options.metric = Metric::line;
  const auto found = lay_onto(target, tree, source, {}, options);
  EXPECT_LT(off(found.T, b), 0.002);
  EXPECT_NEAR(found.T.yaw, b.yaw, 0.001);
}

TEST(Icp, KnowsThatACorridorSaysNothingAboutTheWayAlongIt) {
  Cloud corridor;
  for (int k = 0; k <= 200; ++k)
    for (const float y : {-1.f, 1.f}) {
      corridor.add({-5 + 0.05f * k, y, 0});
      corridor.nx.push_back(0), corridor.ny.push_back(1), corridor.nz.push_back(0);
    }
  const SearchTree tree(corridor);
  IcpOptions options;
  options.metric = Metric::line;
  options.hold = 0.02;
  const auto found = lay_onto(corridor, tree, corridor, {0.3, 0.05, 0}, options);
  EXPECT_NEAR(found.T.y, 0, 4e-3);  // the hold draws it back by 0.05 m * 2500 / (2500 + 44700)
  EXPECT_NEAR(found.T.x, 0.3, 1e-6);
  EXPECT_NEAR(found.information(0, 0), 2500, 1);  // what the hold says
  EXPECT_GT(found.information(1, 1), 40000);
}

TEST(Icp, LeavesThePoseWhereThereIsNothingToPair) {
  Cloud near, far;
  for (int k = 0; k < 10; ++k) near.add({0.1f * k, 0, 0}), far.add({100 + 0.1f * k, 0, 0});
  const SearchTree tree(near);
  const auto found = lay_onto(near, tree, far, {1, 2, 0.5}, {});
  EXPECT_EQ(found.T.x, 1);
  EXPECT_EQ(found.T.yaw, 0.5);
  EXPECT_EQ(found.overlap, 0);
}

Segment segment_of(const Cloud& cloud) {
  Segment segment;
  segment.range.end = 1;
  segment.range.T_segment_frame.resize(1);
  return segment.with(cloud, std::vector<std::uint16_t>(cloud.size(), 0));
}

TEST(RegisterStep, LaysTheSourceOfJOntoTheTargetOfI) {
  const PlanarPose a{}, b{0.1, 0, 0.03};
  const Segment i = segment_of(scan(a, 360, 0.005, 1)), j = segment_of(scan(b, 360, 0.005, 2));
  for (const std::size_t which : {0u, 1u}) {
    StepRun step(*plumb_module(), which);
    TestContext context;
    step.over("edges").ends("targets", i, Segment()).ends("sources", Segment(), j).at("poses", Pose());
    const auto found = step.run<Registration>("registration", context);
    EXPECT_TRUE(found.accepted);
    EXPECT_LT(off(planar(found.T_i_j), b), 0.03);
    EXPECT_EQ(found.T_i_j.translation.z(), 0);
    EXPECT_EQ(context.counts["iterations"], found.iterations);
  }
}

TEST(RegisterStep, SaysWhatALineNeeds) {
  const Segment i = segment_of(scan({}, 90, 0, 1));
  StepRun step(*plumb_module(), 0);
  TestContext context;
  step.over("edges").ends("targets", i, i).ends("sources", i, i).at("poses", Pose()).set("metric", std::string("line"));
  EXPECT_THROW(step.run<Registration>("registration", context), Error);
}

}  // namespace
}  // namespace plumb
