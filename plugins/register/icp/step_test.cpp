#include "plumb/slam/step.hpp"

#include <gtest/gtest.h>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/registration.hpp"
#include "shared/planar/room_testing.hpp"

namespace plumb::register_icp {
namespace {

using planar::PlanarPose;

Cloud scan(const PlanarPose& at, int beams, double noise, unsigned seed) {
  return planar::room_scan<Cloud>(at, beams, noise, seed);
}

TEST(RegisterStep, RegistersTheSourceOfJToTheTargetOfI) {
  const PlanarPose a{}, b{0.1, 0, 0.03};
  const Segment i = segment_of(scan(a, 360, 0.005, 1)), j = segment_of(scan(b, 360, 0.005, 2));
  for (const std::size_t which : {0u, 1u}) {
    StepUnderTest step(*plumb_module(), which);
    TestContext context;
    step.over("edges")
        .ends("targets", i, Segment())
        .ends("sources", Segment(), j)
        .part("poses", Pose());
    const auto found = step.run<Registration>("registration", context);
    EXPECT_TRUE(found.accepted);
    EXPECT_LT(off(planar::projected(found.T_i_j), b), 0.03);
    EXPECT_EQ(found.T_i_j.translation.z(), 0);
    EXPECT_EQ(context.counts["iterations"], found.iterations);
  }
}

TEST(RegisterStep, SaysWhatALineNeeds) {
  const Segment i = segment_of(scan({}, 90, 0, 1));
  StepUnderTest step(*plumb_module(), 0);
  TestContext context;
  step.over("edges")
      .ends("targets", i, i)
      .ends("sources", i, i)
      .part("poses", Pose())
      .set("metric", std::string("line"));
  EXPECT_THROW(step.run<Registration>("registration", context), Error);
}

}  // namespace
}  // namespace plumb::register_icp
