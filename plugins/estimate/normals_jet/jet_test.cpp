#include "jet.hpp"

#include <CGAL/jet_estimate_normals.h>
#include <CGAL/property_map.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/cgal/adapter.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::estimate_normals_jet {
namespace {

constexpr double radius = 2;  // of the pipe [m]

/// A quarter of a pipe along x, 5 cm between points, and how far its true normals are.
Cloud quarter_pipe() {
  Cloud cloud;
  for (int a = 0; a < 40; ++a)
    for (int b = 0; b <= 63; ++b) {
      const double angle = b * std::numbers::pi / 2 / 63;
      cloud.add(Eigen::Vector3d(0.05 * a, radius * std::cos(angle), radius * std::sin(angle))
                    .cast<float>());
    }
  return cloud;
}
Eigen::Vector3f inwards(const Eigen::Vector3f& p) {
  return Eigen::Vector3f(0, -p.y(), -p.z()).normalized();
}
double worst_angle(const Cloud& cloud) {
  double worst = 0;
  for (std::size_t k = 0; k < cloud.size(); ++k)
    worst = std::max(worst,
                     std::acos(std::min(
                         1.0, static_cast<double>(cloud.normal(k).dot(inwards(cloud.point(k)))))));
  return worst;
}
std::size_t estimate(Cloud& cloud, const neighbourhood::Bounds& bounds, std::uint32_t degree) {
  TestContext context;
  JetOptions options;
  options.degree = degree;
  return jet_normals(
      cloud, SearchTree(cloud), bounds, options,
      [](std::size_t) { return Eigen::Vector3f(1, 0, 0); }, context);
}

TEST(JetNormals, AreRightAtTheBorderOfACurvedSurfaceWherePlanesAreNot) {
  Cloud curved = quarter_pipe(), flat = curved;
  EXPECT_EQ(estimate(curved, {0.4, {}}, 2), 0u);
  EXPECT_EQ(estimate(flat, {0.4, {}}, 1), 0u);
  EXPECT_LT(worst_angle(curved), 0.5 * deg);
  EXPECT_GT(worst_angle(flat), 3 * deg) << "the neighbours lie to one side";
}

TEST(JetNormals, AreThoseThatCgalGivesForAWholeCloud) {
  Random random(2);
  Cloud cloud;
  for (int k = 0; k < 1500; ++k) {
    const double x = 4 * random.uniform(), y = 4 * random.uniform();
    cloud.add(Eigen::Vector3d(x, y, 0.3 * std::sin(2 * x) + 0.1 * y * y).cast<float>());
  }
  using PointAndNormal = std::pair<cgal::Point, cgal::Vector>;
  std::vector<PointAndNormal> judge;
  for (const auto& point : cgal::points_of(cloud))
    judge.emplace_back(point, cgal::Vector(0.0, 0.0, 0.0));
  CGAL::jet_estimate_normals<CGAL::Sequential_tag>(
      judge, 24,  // beside the point itself
      CGAL::parameters::point_map(CGAL::First_of_pair_property_map<PointAndNormal>())
          .normal_map(CGAL::Second_of_pair_property_map<PointAndNormal>())
          .degree_fitting(2));
  EXPECT_EQ(estimate(cloud, {{}, 25}, 2), 0u);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f expected = cgal::eigen_of(judge[k].second).cast<float>();
    EXPECT_NEAR(std::abs(cloud.normal(k).dot(expected)), 1, 1e-4) << k;
  }
}

TEST(JetNormals, AreZeroForOutliersLinesAndTooFewPoints) {
  Cloud cloud;
  cloud.add({100, 0, 0});
  for (int k = 0; k < 50; ++k) cloud.add({0, 0.1f * static_cast<float>(k), 0});
  for (int k = 0; k < 5; ++k)
    cloud.add({50, std::sin(3.f * static_cast<float>(k)), 0.1f * static_cast<float>(k)});
  cloud.add({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  EXPECT_EQ(estimate(cloud, {2.0, 10}, 2), 57u) << "five points do not make six coefficients";
  for (std::size_t k = 0; k < cloud.size(); ++k) EXPECT_TRUE(cloud.normal(k).isZero());
}

TEST(JetNormals, AreTheSameForOneAndForFourThreads) {
  Cloud one = quarter_pipe(), four = one;
  const SearchTree tree(one);
  const auto origin = [](std::size_t) { return Eigen::Vector3f(1, 0, 0); };
  TestContext alone;
  parallel::ThreadedContext together;
  jet_normals(one, tree, {0.5, 20}, {}, origin, alone);
  jet_normals(four, tree, {0.5, 20}, {}, origin, together);
  EXPECT_EQ(one.nx, four.nx);
  EXPECT_EQ(one.ny, four.ny);
  EXPECT_EQ(one.nz, four.nz);
}

TEST(EstimateNormalsJetStep, TurnsEachNormalToTheSensorOfItsOwnFrame) {
  Cloud cloud;  // a horizontal patch, seen from above (even points) and from below (odd points)
  std::vector<std::uint16_t> frames;
  for (int k = 0; k < 400; ++k) {
    cloud.add({0.2f * static_cast<float>(k % 20), 0.2f * static_cast<float>(k / 20), 0});
    frames.push_back(static_cast<std::uint16_t>(k % 2));
  }
  cloud.add({50, 50, 0});
  frames.push_back(0);
  Segment segment;
  segment.range.end = 2;
  segment.range.T_segment_frame = {Pose(Eigen::Quaterniond::Identity(), {2, 2, 3}),
                                   Pose(Eigen::Quaterniond::Identity(), {2, 2, -3})};
  TestContext context;
  const auto result = StepUnderTest(*plumb_module())
                          .with("segment", segment.with(std::move(cloud), std::move(frames)))
                          .run<Segment>("segment", context);
  ASSERT_EQ(result.cloud.size(), 401u);
  for (std::size_t k = 0; k < 400; ++k) EXPECT_NEAR(result.cloud.nz[k], k % 2 ? -1 : 1, 1e-4);
  EXPECT_TRUE(result.cloud.normal(400).isZero());
  EXPECT_EQ(context.counts["points without a normal"], 1u);
}

TEST(EstimateNormalsJetStep, RefusesANeighbourhoodWithoutBounds) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("segment", Segment())
      .set("radius", std::monostate())
      .set("max_neighbours", std::monostate());
  EXPECT_THROW(step.run<Segment>("segment", context), Error);
}

}  // namespace
}  // namespace plumb::estimate_normals_jet
