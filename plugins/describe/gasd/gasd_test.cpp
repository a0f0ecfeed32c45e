#include "gasd.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::describe_gasd {
namespace {

/// A street that is longer than wide and wider than high, with more on one end.
Cloud street(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  for (std::size_t k = 0; k < count; ++k) {
    const float along = uniform(0, 1), a = uniform(-5, 5), up = uniform(0, 4);
    const float x = 20 * along * along;
    if (k % 3 < 2) cloud.add({x, a, 0});
    if (k % 3 == 2) cloud.add({x, a > 0 ? 5.f : -5.f, a > 2 ? up : 0.5f * up});
  }
  return cloud;
}

double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(a[k] - b[k]);
  return sum;
}

/// GASD without interpolation as it is defined.
std::vector<float> plainly(const Cloud& cloud) {
  Eigen::MatrixXd points(3, static_cast<Eigen::Index>(cloud.size()));
  for (std::size_t k = 0; k < cloud.size(); ++k)
    points.col(static_cast<Eigen::Index>(k)) = cloud.point(k).cast<double>();
  points.colwise() -= points.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      Eigen::Matrix3d(points * points.transpose()));
  Eigen::Vector3d z = solver.eigenvectors().col(0), x = solver.eigenvectors().col(2);
  if (z.z() > 0) z = -z;
  if ((x.transpose() * points).array().cube().sum() < 0) x = -x;
  Eigen::Matrix3d axes;
  axes << x.transpose(), z.cross(x).transpose(), z.transpose();
  const Eigen::MatrixXd turned = axes * points;
  const double half = turned.cwiseAbs().maxCoeff();
  std::vector<float> counts(gasd_size, 0);
  float all = 0;
  for (Eigen::Index n = 0; n < turned.cols(); ++n) {
    const Eigen::Vector3d at = (turned.col(n) / half).array() * 4 + 4;
    if (at.maxCoeff() >= 8) continue;  // the farthest point lies on the cube's face
    const auto cell = [&](int c) { return static_cast<std::size_t>(std::floor(at[c])); };
    ++counts[(cell(0) * gasd_side + cell(1)) * gasd_side + cell(2)];
    ++all;
  }
  for (auto& count : counts) count /= all;
  return counts;
}

TEST(Gasd, IsWhatItsDefinitionGives) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Cloud cloud =
        pcl::moved(street(4000, seed),
                   Pose(exp_rotation({0.05, -0.1, 2.0 * static_cast<double>(seed)}), {40, -7, 3}));
    EXPECT_LT(difference(gasd(cloud, Interpolation::none).value(), plainly(cloud)), 0.01) << seed;
  }
}

TEST(Gasd, SumsToOneAndHasNoNegativeNumber) {
  const auto values = gasd(street(3000, 4), Interpolation::quadrilinear).value();
  ASSERT_EQ(values.size(), 512u);
  EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 1, 1e-5);
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0);
}

TEST(Gasd, IsTheSameWhicheverWayTheStreetIsDriven) {
  const Cloud cloud = street(3000, 5);
  const auto values = gasd(cloud, Interpolation::quadrilinear).value();
  for (const double turn : {0.4, 1.6, std::numbers::pi, 4.0, 5.5}) {
    const Cloud elsewhere = pcl::moved(cloud, Pose(exp_rotation({0, 0, turn}), {-30, 12, 2}));
    EXPECT_LT(difference(values, gasd(elsewhere, Interpolation::quadrilinear).value()), 0.01)
        << turn;
  }
}

TEST(Gasd, SeesLessOfNoiseWithInterpolation) {
  const Cloud cloud = street(3000, 6);
  Cloud noisy = cloud;
  Random random(7);
  for (auto* array : {&noisy.x, &noisy.y, &noisy.z})
    for (auto& value : *array) value += static_cast<float>(0.3 * (random.uniform() - 0.5));
  const auto changed = [&](Interpolation interpolation) {
    return difference(gasd(cloud, interpolation).value(), gasd(noisy, interpolation).value());
  };
  EXPECT_LT(changed(Interpolation::quadrilinear), 0.8 * changed(Interpolation::none));
}

TEST(Gasd, TellsPlacesApartAndKnowsThemAgain) {
  const auto once = gasd(street(4000, 8), Interpolation::quadrilinear).value(),
             again = gasd(street(4000, 9), Interpolation::quadrilinear).value(),
             corner = gasd(pcl::street_corner(4000, 8), Interpolation::quadrilinear).value();
  EXPECT_LT(difference(once, again), 0.25);
  EXPECT_GT(difference(once, corner), 0.6);
}

TEST(Gasd, IsNothingWithoutExtent) {
  Cloud cloud;
  EXPECT_FALSE(gasd(cloud, Interpolation::none));
  for (int k = 0; k < 50; ++k) cloud.add({3, 3, 3});
  EXPECT_FALSE(gasd(cloud, Interpolation::none));
  EXPECT_FALSE(gasd(cloud, Interpolation::quadrilinear));
}

TEST(DescribeGasdStep, GivesADescriptorAsEsfDoes) {
  TestContext context;
  StepUnderTest step(*plumb_module());
  const Cloud cloud = street(2000, 10);
  const auto found = step.with("segment", pcl::segment_of(cloud))
                         .set("interpolation", std::string("none"))
                         .run<Descriptor>("descriptor", context);
  EXPECT_EQ(found.values, gasd(cloud, Interpolation::none).value());
  EXPECT_TRUE(context.warnings.empty());
  const auto none = step.with("segment", Segment()).run<Descriptor>("descriptor", context);
  EXPECT_EQ(none.values, std::vector<float>(512, 0.0f));
  EXPECT_EQ(context.warnings.size(), 1u);
}

}  // namespace
}  // namespace plumb::describe_gasd
