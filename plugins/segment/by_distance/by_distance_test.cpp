#include "by_distance.hpp"

#include <gmock/gmock.h>

#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(SegmentByDistance, CutsWhereThePathExceedsTheLength) {
  EXPECT_THAT(starts_by_distance({0, 1, 2, 3, 4, 5, 6, 7, 8}, 2, {}), ElementsAre(0, 3, 6));
}

TEST(SegmentByDistance, GivesEachFrameItsOwnSegmentWhenFramesAreFartherApart) {
  EXPECT_THAT(starts_by_distance({0, 30, 60}, 15, {}), ElementsAre(0, 1, 2));
}

TEST(SegmentByDistance, JoinsALastSegmentUnderHalfToTheOneBefore) {
  EXPECT_THAT(starts_by_distance({0, 2, 4, 6, 7.9}, 4, {}), ElementsAre(0));  // 1.9 m left of 4
  EXPECT_THAT(starts_by_distance({0, 2, 4, 6, 8.0}, 4, {}),
              ElementsAre(0, 3));  // exactly half stays
}

TEST(SegmentByDistance, DoesNotCutWhileTheSensorRests) {
  EXPECT_THAT(starts_by_distance(std::vector<double>(1000, 0.0), 15, {}), ElementsAre(0));
}

TEST(SegmentByDistance, CutsARestByItsFramesWhenToldTo) {
  EXPECT_THAT(starts_by_distance(std::vector<double>(10, 0.0), 15, 4), ElementsAre(0, 4, 8));
  EXPECT_THAT(starts_by_distance(std::vector<double>(9, 0.0), 15, 4),
              ElementsAre(0, 4));  // 1 left of 4
}

TEST(SegmentByDistance, KeepsAShortRunWhole) {
  EXPECT_THAT(starts_by_distance({0, 1}, 15, {}), ElementsAre(0));
  EXPECT_THAT(starts_by_distance({}, 15, {}), IsEmpty());
}

TEST(SegmentByDistance, MeasuresThePathAndNotTheDistanceFromTheStart) {
  Trajectory trajectory;  // out and back between 0 and 1 m, 10 m in all
  for (int k = 0; k <= 10; ++k) {
    trajectory.stamps.push_back(k);
    trajectory.T_world_frame.push_back(
        {Eigen::Quaterniond::Identity(), {static_cast<double>(k % 2), 0, 0}});
  }
  const Step& step = *plumb_module()->steps[0];
  PortInput input;
  input.wired = true;
  input.one = any_value(trajectory);
  PortOutput outputs[2];
  TestContext context;
  step.run(step.parameters({{"length", 4.0}}).get(), {&input, 1}, outputs, context);
  ASSERT_EQ(outputs[0].many.size(), 2u);
  EXPECT_EQ(outputs[0].many[0].as<Range>()->end, 5u);
  EXPECT_EQ(outputs[0].many[1].as<Range>()->end, 11u);
  EXPECT_EQ(outputs[1].one.as<Poses>()->size(), 2u);
}

TEST(ByDistance, ATurnBeginsASegmentTooAndKeepsItsLastOne) {
  const std::vector<double> heading = {0, 0.1, 0.2, 0.4, 0.5, 0.9};
  const auto breaks = [&](std::size_t first, std::size_t k) { return heading[k] - heading[first] > 0.25; };
  EXPECT_THAT(starts_by_distance({0, 0, 0, 0, 0, 0}, 1, {}, breaks), ElementsAre(0, 3, 5));
}

}  // namespace
}  // namespace plumb
