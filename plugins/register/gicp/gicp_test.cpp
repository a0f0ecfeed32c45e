#include "gicp.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::register_gicp {
namespace {

using pcl::moved;
using pcl::segment_of;
using pcl::street_corner;

const Pose truth(exp_rotation({0.01, -0.015, 0.03}), {0.3, -0.2, 0.08});

double meters_off(const Pose& found) { return (found.translation - truth.translation).norm(); }
double radians_off(const Pose& found) { return angle(truth.inverse() * found); }

Cloud without_normals(Cloud cloud) {
  cloud.nx.clear(), cloud.ny.clear(), cloud.nz.clear();
  return cloud;
}

TEST(Gicp, FindsTheMotionBetweenTwoScansOfOnePlace) {
  const Cloud target = street_corner(12000, 1);
  const Cloud source = moved(street_corner(4000, 2), truth.inverse());
  const auto found = gicp(target, source, Pose(), 1, {});
  EXPECT_TRUE(found.converged);
  EXPECT_GT(found.iterations, 1u);
  EXPECT_LT(meters_off(found.T_i_j), 0.04);
  EXPECT_LT(radians_off(found.T_i_j), 0.006);
}

TEST(Gicp, TakesCovariancesFromNeighboursWhereThereAreNoNormals) {
  const Cloud target = without_normals(street_corner(12000, 3));
  const Cloud source = without_normals(moved(street_corner(4000, 4), truth.inverse()));
  const auto found = gicp(target, source, Pose(), 1, {});
  EXPECT_TRUE(found.converged);
  EXPECT_LT(meters_off(found.T_i_j), 0.08);
  EXPECT_LT(radians_off(found.T_i_j), 0.01);
}

TEST(Gicp, SeesTheDistanceOfTwoWallsToTheirNoise) {
  // Two samples of one wall, 0.2 m apart across it.
  const auto wall = [](std::uint64_t seed, float y) {
    Random random(seed);
    Cloud cloud;
    for (int k = 0; k < 4000; ++k) {
      const auto x = static_cast<float>(20 * random.uniform()),
                 z = static_cast<float>(5 * random.uniform());
      cloud.add({x, y, z});
      cloud.nx.push_back(0), cloud.ny.push_back(1), cloud.nz.push_back(0);
    }
    return cloud;
  };
  const auto found = gicp(wall(5, 0), wall(6, 0.2f), Pose(), 1, {});
  EXPECT_NEAR(found.T_i_j.translation.y(), -0.2, 0.01);
  EXPECT_LT(std::abs(found.T_i_j.translation.x()), 0.1);
}

TEST(Gicp, FindsNothingWithoutPairsOrPoints) {
  const Cloud cloud = street_corner(500, 7), few = without_normals(street_corner(15, 7));
  const Pose far(Eigen::Quaterniond::Identity(), {80, 0, 0});
  EXPECT_FALSE(gicp(cloud, cloud, far, 1, {}).converged);
  EXPECT_FALSE(gicp(few, cloud, Pose(), 1, {}).converged);
  EXPECT_FALSE(gicp(Cloud(), cloud, Pose(), 1, {}).converged);
  EXPECT_FALSE(gicp(cloud, Cloud(), Pose(), 1, {}).converged);
}

TEST(RegisterGicpStep, HasThePortsOfIcp) {
  const Segment i = segment_of(street_corner(12000, 6)),
                j = segment_of(moved(street_corner(4000, 7), truth.inverse()));
  StepUnderTest step(*plumb_module());
  step.over("edges")
      .ends("targets", i, Segment())
      .ends("sources", Segment(), j)
      .part("poses", Pose())
      .set("max_correspondence_distance", 1.0);
  TestContext context;
  const auto found = step.run<Registration>("registration", context);
  EXPECT_TRUE(found.accepted);
  EXPECT_LT(meters_off(found.T_i_j), 0.05);
  EXPECT_GT(found.overlap, 0.9f);
  EXPECT_GT(found.information.diagonal().minCoeff(), 0);
  EXPECT_EQ(context.counts["iterations"], found.iterations);

  Registration initial;
  initial.T_i_j = truth;
  initial.accepted = true;
  step.with("initial", initial).part("poses", Pose(Eigen::Quaterniond::Identity(), {80, 0, 0}));
  EXPECT_TRUE(step.run<Registration>("registration", context).accepted);
}

TEST(RegisterGicpStep, DoesNotAcceptWhatDoesNotOverlap) {
  const Segment i = segment_of(street_corner(4000, 8));
  const Pose far(Eigen::Quaterniond::Identity(), {80, 0, 0});
  TestContext context;
  const auto found = StepUnderTest(*plumb_module())
                         .over("edges")
                         .ends("targets", i, i)
                         .ends("sources", i, i)
                         .part("poses", far)
                         .run<Registration>("registration", context);
  EXPECT_FALSE(found.accepted);
  EXPECT_EQ(context.counts["registrations not accepted"], 1u);
}

}  // namespace
}  // namespace plumb::register_gicp
