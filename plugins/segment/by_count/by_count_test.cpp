#include "by_count.hpp"

#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::segment_by_count {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(SegmentByCount, BeginsASegmentEveryNFrames) {
  EXPECT_THAT(starts_by_count(9, 3), ElementsAre(0, 3, 6));
  EXPECT_THAT(starts_by_count(3, 1), ElementsAre(0, 1, 2));
}

TEST(SegmentByCount, JoinsALastSegmentUnderHalfToTheOneBefore) {
  EXPECT_THAT(starts_by_count(12, 5), ElementsAre(0, 5));      // 2 left of 5
  EXPECT_THAT(starts_by_count(13, 5), ElementsAre(0, 5, 10));  // 3 left of 5
  EXPECT_THAT(starts_by_count(10, 4), ElementsAre(0, 4, 8));   // exactly half stays
}

TEST(SegmentByCount, MovesAllCutsByItsPhase) {
  EXPECT_THAT(starts_by_count(20, 6, 0), ElementsAre(0, 6, 12));
  EXPECT_THAT(starts_by_count(20, 6, 0.5), ElementsAre(0, 3, 9, 15));
  EXPECT_THAT(starts_by_count(3, 1, 0.5), ElementsAre(0, 1, 2));
  EXPECT_THAT(starts_by_count(2, 6, 0.5), ElementsAre(0));
}

TEST(SegmentByCount, KeepsASingleSegmentHoweverShort) {
  EXPECT_THAT(starts_by_count(2, 60), ElementsAre(0));
  EXPECT_THAT(starts_by_count(0, 60), IsEmpty());
}

TEST(SegmentByCount, MakesAboutAsManySegmentsAsAskedFor) {
  EXPECT_EQ(frames_for(2700, 45), 60u);
  EXPECT_EQ(frames_for(2018, 34), 60u);  // 59.4
  EXPECT_EQ(frames_for(10, 4), 3u);
  EXPECT_EQ(frames_for(3, 60), 1u);
  EXPECT_EQ(frames_for(0, 60), 1u);
  EXPECT_THAT(starts_by_count(100, frames_for(100, 7)), ElementsAre(0, 15, 30, 45, 60, 75, 90));
}

Trajectory turning(std::size_t frames) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < frames; ++k) {
    const double s = static_cast<double>(k);
    trajectory.stamps.push_back(s);
    trajectory.T_world_frame.push_back(
        {exp_rotation({0.01 * s, 0, 0.1 * s}), {500000 + s, 2 * s, -s}});
  }
  return trajectory;
}

std::vector<FrameRange> run(const Trajectory& trajectory, const ParameterValues& values,
                            Poses& poses) {
  const Step& step = *plumb_module()->steps[0];
  PortInput input;
  input.wired = true;
  input.one = any_value(trajectory);
  PortOutput outputs[2];
  TestContext context;
  step.run(step.parameters(values).get(), {&input, 1}, outputs, context);
  std::vector<FrameRange> ranges;
  for (const auto& value : outputs[0].many) ranges.push_back(*value.as<FrameRange>());
  poses = *outputs[1].one.as<Poses>();
  return ranges;
}
std::vector<FrameRange> run(const Trajectory& trajectory, std::int64_t frames, Poses& poses) {
  return run(trajectory, ParameterValues{{"frames", frames}}, poses);
}

TEST(SegmentByCount, TakesTheNumberOfSegmentsBeforeThatOfFrames) {
  Poses poses;
  const ParameterValues values{{"frames", std::int64_t{5}}, {"segments", std::int64_t{2}}};
  EXPECT_EQ(run(turning(24), values, poses).size(), 2u);
  EXPECT_EQ(poses.size(), 2u);
  EXPECT_EQ(run(turning(24), 5, poses).size(), 5u);
}

TEST(SegmentByCount, PutsEachSegmentIntoItsMiddleFrameAndCoversTheTrajectory) {
  const Trajectory trajectory = turning(23);
  Poses poses;
  const auto ranges = run(trajectory, 5, poses);
  ASSERT_EQ(ranges.size(), 5u);
  ASSERT_EQ(poses.size(), 5u);
  std::uint32_t next = 0;
  for (std::size_t s = 0; s < ranges.size(); ++s) {
    const FrameRange& range = ranges[s];
    EXPECT_EQ(range.first, next);
    next = range.end;
    ASSERT_EQ(range.T_segment_frame.size(), range.size());
    EXPECT_EQ(poses.T_world_segment[s].translation, range.T_world_segment.translation);
    const Pose& middle = range.T_segment_frame[range.size() / 2];
    EXPECT_LT(middle.translation.norm() + angle(middle), 1e-12);
    for (std::size_t k = 0; k < range.size(); ++k) {
      const Pose back = range.T_world_segment * range.T_segment_frame[k];
      const Pose& given = trajectory.T_world_frame[range.first + k];
      EXPECT_LT((back.translation - given.translation).norm(), 1e-9);
      EXPECT_LT(angle(back.inverse() * given), 1e-9);
    }
  }
  EXPECT_EQ(next, 23u);
}

TEST(SegmentByCount, RefusesMoreFramesThanAPointCanName) {
  Poses poses;
  EXPECT_EQ(run(turning(65535), 65535, poses).size(), 1u);
  EXPECT_THAT(
      io::refusal([&] { run(turning(65536 + 20000), 65535, poses); }),  // the last 20001 join
      HasSubstr("at most 65535 are possible"));
}

}  // namespace
}  // namespace plumb::segment_by_count
