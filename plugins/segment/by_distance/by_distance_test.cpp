#include "by_distance.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::segment_by_distance {
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

TEST(SegmentByDistance, MovesAllCutsByItsPhase) {
  const std::vector<double> travelled{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  EXPECT_THAT(starts_by_distance(travelled, 4, {}, {}, 0), ElementsAre(0, 5, 10));
  EXPECT_THAT(starts_by_distance(travelled, 4, {}, {}, 0.25), ElementsAre(0, 4, 9));
  EXPECT_THAT(starts_by_distance(travelled, 4, {}, {}, 0.5), ElementsAre(0, 3, 8));
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
  PortInput inputs[2];
  inputs[0].wired = true;
  inputs[0].one = any_value(trajectory);
  PortOutput outputs[2];
  TestContext context;
  step.run(step.parameters({{"length", 4.0}}).get(), inputs, outputs, context);
  ASSERT_EQ(outputs[0].many.size(), 2u);
  EXPECT_EQ(outputs[0].many[0].as<FrameRange>()->end, 5u);
  EXPECT_EQ(outputs[0].many[1].as<FrameRange>()->end, 11u);
  EXPECT_EQ(outputs[1].one.as<Poses>()->size(), 2u);
}

TEST(ByDistance, ATurnBeginsASegmentTooAndKeepsItsLastOne) {
  const std::vector<double> heading = {0, 0.1, 0.2, 0.4, 0.5, 0.9};
  const auto breaks = [&](std::size_t first, std::size_t k) {
    return heading[k] - heading[first] > 0.25;
  };
  EXPECT_THAT(starts_by_distance({0, 0, 0, 0, 0, 0}, 1, {}, breaks), ElementsAre(0, 3, 5));
}

TEST(GrownLength, StaysWhereThePathMakesFewEnough) {
  EXPECT_EQ(grown_length(1000, 10, 50.0, 100), 10);
  EXPECT_EQ(grown_length(5, 10, 50.0, 100), 10);
  EXPECT_EQ(grown_length(0, 10, 50.0, 100), 10);
}

TEST(GrownLength, GrowsWithThePathUpToTheMost) {
  EXPECT_DOUBLE_EQ(grown_length(3000, 10, 50.0, 100), 30);
  EXPECT_EQ(grown_length(5000, 10, 50.0, 100), 50);
  EXPECT_EQ(grown_length(1e6, 10, 50.0, 100), 50);
}

TEST(GrownLength, DoesNotGrowWithoutAMost) { EXPECT_EQ(grown_length(1e6, 10, {}, 1), 10); }

TEST(GrownLength, MakesNoMoreSegmentsThanAskedForHoweverFramesLie) {
  Random random(1);
  for (const std::size_t most : {1u, 2u, 7u, 40u}) {
    std::vector<double> travelled{0};
    while (travelled.size() < 2000) travelled.push_back(travelled.back() + 3 * random.uniform());
    const double length = grown_length(travelled.back(), 1, 1e6, most);
    const auto segments = starts_by_distance(travelled, length, {}).size();
    EXPECT_LE(segments, most);
    EXPECT_GE(segments, most - most / 5) << "and not much fewer";
  }
}

double seconds(std::size_t k) { return static_cast<double>(k); }

/// Ends of the segments of `frames` frames, 1 m apart, with the stamps [s] that are given.
std::vector<std::size_t> ends_of(std::size_t frames, const ParameterValues& values,
                                 const std::function<double(std::size_t)>& stamp = seconds) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < frames; ++k) {
    trajectory.stamps.push_back(stamp(k));
    trajectory.T_world_frame.push_back(
        {Eigen::Quaterniond::Identity(), {static_cast<double>(k), 0, 0}});
  }
  const Step& step = *plumb_module()->steps[0];
  std::vector<PortInput> inputs(step.description().inputs.size());
  inputs[0].wired = true;
  inputs[0].one = any_value(trajectory);
  PortOutput outputs[2];
  TestContext context;
  step.run(step.parameters(values).get(), inputs, outputs, context);
  std::vector<std::size_t> ends;
  for (const auto& range : outputs[0].many) ends.push_back(range.as<FrameRange>()->end);
  return ends;
}

TEST(SegmentByDistance, GrowsItsSegmentsOnALongWayWhenToldTo) {
  using Values = ParameterValues;
  EXPECT_EQ(ends_of(101, Values{{"length", 4.0}}).size(), 20u);
  EXPECT_EQ(ends_of(101, Values{{"length", 4.0}, {"max_segments", std::int64_t{5}}}).size(), 20u)
      << "only with max_length";
  EXPECT_THAT(
      ends_of(101,
              Values{{"length", 4.0}, {"max_length", 60.0}, {"max_segments", std::int64_t{5}}}),
      ElementsAre(21, 42, 63, 84, 101));
  EXPECT_EQ(
      ends_of(101, Values{{"length", 4.0}, {"max_length", 9.0}, {"max_segments", std::int64_t{5}}})
          .size(),
      10u);
  EXPECT_EQ(
      ends_of(21, Values{{"length", 4.0}, {"max_length", 60.0}, {"max_segments", std::int64_t{5}}}),
      ends_of(21, Values{{"length", 4.0}}));
}

TEST(SegmentByDistance, CutsByTimeWhenToldToAndKeepsItsLastSegment) {
  // A frame a second and a metre.
  EXPECT_THAT(ends_of(10, {{"length", 1000.0}, {"max_duration", 3.0}}), ElementsAre(3, 6, 9, 10));
  EXPECT_THAT(ends_of(10, {{"length", 1000.0}, {"max_duration", 2.5}}), ElementsAre(3, 6, 9, 10));
  EXPECT_THAT(ends_of(9, {{"length", 4.0}, {"max_duration", 3.0}}), ElementsAre(3, 6, 9));
  EXPECT_THAT(ends_of(10, {{"length", 1.0}, {"max_duration", 3.0}}), ElementsAre(2, 4, 6, 8, 10));
}

TEST(SegmentByDistance, CutsByTimeWhereStampsAreRoundedOrStepBack) {
  // Five frames a second at great stamps, which a double holds to a quarter of a microsecond.
  EXPECT_THAT(ends_of(11, {{"length", 1000.0}, {"max_duration", 1.0}},
                      [](std::size_t k) { return 1.2e9 + 0.2 * static_cast<double>(k); }),
              ElementsAre(5, 10, 11));
  EXPECT_THAT(ends_of(6, {{"length", 1000.0}, {"max_duration", 1.0}},
                      [](std::size_t k) { return k == 2 ? -5.0 : 0.4 * static_cast<double>(k); }),
              ElementsAre(3, 6));  // 0, 0.4, -5, and the second from 1.2 on
}

TEST(SegmentByDistance, RefusesAMostLengthUnderTheLength) {
  const Step& step = *plumb_module()->steps[0];
  const ParameterValues wrong = {{"length", 15.0}, {"max_length", 10.0}};
  EXPECT_THAT(io::refusal([&] { step.parameters(wrong); }),
              testing::HasSubstr("max_length must not be smaller than length"));
  EXPECT_NO_THROW(step.parameters({{"length", 15.0}, {"max_length", 15.0}}));
}

}  // namespace
}  // namespace plumb::segment_by_distance
