#include "iss.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <iterator>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::keypoints_iss {
namespace {

using pcl::street_corner;
using testing::IsEmpty;

constexpr IssOptions wide{.salient_radius = 1.5, .non_max_radius = 1.0};

bool within(const Cloud& cloud, std::size_t a, std::size_t b, double radius) {
  return (cloud.point(a) - cloud.point(b)).squaredNorm() <= radius * radius;
}

/// The third eigenvalue of a point's scatter, 0 where the point is no candidate.
double salience(const Cloud& cloud, std::size_t k, const IssOptions& options) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  std::uint32_t neighbours = 0;
  for (std::size_t m = 0; m < cloud.size(); ++m) {
    if (!within(cloud, k, m, options.salient_radius)) continue;
    const Eigen::Vector3d off = cloud.point(m).cast<double>() - cloud.point(k).cast<double>();
    scatter += off * off.transpose();
    ++neighbours;
  }
  if (neighbours < options.min_neighbours) return 0;
  const Eigen::Vector3d e = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  return e[1] / e[2] < options.gamma_21 && e[0] / e[1] < options.gamma_32 ? e[0] : 0;
}

/// ISS as it is defined, point by point.
std::vector<std::uint32_t> plainly(const Cloud& cloud, const IssOptions& options) {
  std::vector<double> of(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k) of[k] = salience(cloud, k, options);
  std::vector<std::uint32_t> kept;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    std::uint32_t neighbours = 0;
    bool greatest = of[k] > 0;
    for (std::size_t m = 0; m < cloud.size(); ++m)
      if (within(cloud, k, m, options.non_max_radius))
        ++neighbours, greatest = greatest && of[m] <= of[k];
    if (greatest && neighbours >= options.min_neighbours)
      kept.push_back(static_cast<std::uint32_t>(k));
  }
  return kept;
}

TEST(Iss, IsWhatItsDefinitionGives) {
  const Cloud cloud = street_corner(2500, 1);
  const auto kept = iss(cloud, wide);
  EXPECT_GT(kept.size(), 20u);
  EXPECT_EQ(kept, plainly(cloud, wide));
}

TEST(Iss, FindsTheSamePointsInAMovedCloud) {
  const Cloud cloud = street_corner(4000, 2);
  const Cloud elsewhere = pcl::moved(cloud, Pose(exp_rotation({0.3, -0.2, 1.9}), {15, -30, 4}));
  const auto here = iss(cloud, wide), there = iss(elsewhere, wide);
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(here, there, std::back_inserter(both));
  EXPECT_GE(both.size(), here.size() * 95 / 100);
  EXPECT_LE(there.size(), here.size() * 105 / 100);
}

TEST(Iss, FindsNothingWhereThereIsNoThicknessOrAreTooFewPoints) {
  Random random(5);
  Cloud plane, line;
  for (int k = 0; k < 2000; ++k) {
    const auto x = static_cast<float>(10 * random.uniform()),
               y = static_cast<float>(10 * random.uniform());
    plane.add({x, y, 0});
    line.add({x, 1, 2});
  }
  EXPECT_THAT(iss(plane, wide), IsEmpty());
  EXPECT_THAT(iss(line, wide), IsEmpty());
  EXPECT_THAT(iss(street_corner(20, 1), wide), IsEmpty());
  EXPECT_THAT(iss(Cloud(), wide), IsEmpty());
}

TEST(KeypointsIssStep, GivesThePointsWithAllThatIsKnownOfThem) {
  const Cloud cloud = street_corner(2500, 1);
  TestContext context;
  const auto keypoints = StepUnderTest(*plumb_module())
                             .with("segment", pcl::segment_of(cloud))
                             .set("salient_radius", 1.5)
                             .set("non_max_radius", 1.0)
                             .run<Segment>("keypoints", context);
  const auto kept = iss(cloud, wide);
  EXPECT_EQ(keypoints.cloud.x, select(cloud, kept).x);
  EXPECT_TRUE(keypoints.cloud.has_normals());
  EXPECT_EQ(context.counts["keypoints"], kept.size());
}

}  // namespace
}  // namespace plumb::keypoints_iss
