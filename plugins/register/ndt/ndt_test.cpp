#include "ndt.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "shared/pcl/street_testing.hpp"

namespace plumb::register_ndt {
namespace {

using pcl::moved;
using pcl::segment_of;
using pcl::street_corner;

const Pose truth(exp_rotation({0.01, -0.015, 0.03}), {0.3, -0.2, 0.08});

double meters_off(const Pose& found) { return (found.translation - truth.translation).norm(); }
double radians_off(const Pose& found) { return angle(truth.inverse() * found); }

TEST(Ndt, FindsTheMotionBetweenTwoScansOfOnePlace) {
  const Cloud target = street_corner(12000, 1);
  const Cloud source = moved(street_corner(4000, 2), truth.inverse());
  const auto found = ndt(target, source, Pose(), {});
  EXPECT_TRUE(found.converged);
  EXPECT_GT(found.iterations, 1u);
  EXPECT_LT(meters_off(found.T_i_j), 0.15);
  EXPECT_LT(radians_off(found.T_i_j), 0.01);
}

TEST(Ndt, StaysWhereItIsRight) {
  const Cloud target = street_corner(12000, 3);
  const auto found = ndt(target, moved(street_corner(4000, 4), truth.inverse()), truth, {});
  EXPECT_LT(meters_off(found.T_i_j), 0.1);
  EXPECT_LT(radians_off(found.T_i_j), 0.01);
}

TEST(Ndt, FindsNothingWithoutDistributions) {
  const Cloud few = street_corner(60, 5);
  EXPECT_FALSE(ndt(few, few, Pose(), {.resolution = 0.1}).converged);
  EXPECT_FALSE(ndt(Cloud(), few, Pose(), {}).converged);
  EXPECT_FALSE(ndt(few, Cloud(), Pose(), {}).converged);
}

TEST(RegisterNdtStep, HasThePortsOfIcp) {
  const Segment i = segment_of(street_corner(12000, 6)),
                j = segment_of(moved(street_corner(4000, 7), truth.inverse()));
  StepUnderTest step(*plumb_module());
  step.over("edges")
      .ends("targets", i, Segment())
      .ends("sources", Segment(), j)
      .part("poses", Pose());
  TestContext context;
  const auto found = step.run<Registration>("registration", context);
  EXPECT_TRUE(found.accepted);
  EXPECT_LT(meters_off(found.T_i_j), 0.1);
  EXPECT_GT(found.overlap, 0.9f);
  EXPECT_GT(found.information.diagonal().minCoeff(), 0);
  EXPECT_EQ(context.counts["iterations"], found.iterations);

  Registration initial;
  initial.T_i_j = truth;
  initial.accepted = true;
  step.with("initial", initial).part("poses", Pose(Eigen::Quaterniond::Identity(), {80, 0, 0}));
  EXPECT_TRUE(step.run<Registration>("registration", context).accepted);
}

TEST(RegisterNdtStep, DoesNotAcceptWhatDoesNotOverlap) {
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
}  // namespace plumb::register_ndt
