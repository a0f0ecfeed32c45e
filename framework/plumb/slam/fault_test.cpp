#include "plumb/slam/fault.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "plumb/slam/cloud_testing.hpp"
#include "plumb/slam/types.hpp"

namespace plumb {
namespace {

using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// What is said of a sound value after `spoil`; the value is asked before too.
template <class T, class Spoil>
std::string fault_after(const T& sound, Spoil spoil) {
  EXPECT_STREQ(fault_in(sound), "");
  T spoilt = sound;
  spoil(spoilt);
  return fault_in(spoilt);
}

FrameRange sound_range() {
  FrameRange range;
  range.first = 3, range.end = 6;
  range.T_segment_frame.resize(3);
  return range;
}

Segment sound_segment() {
  Segment segment;
  segment.range = sound_range();
  return segment.with(full_cloud(4), {0, 1, 2, 2});
}

Matches sound_matches() {
  Matches matches;
  matches.p = {{1, 2, 3}, {4, 5, 6}}, matches.q = matches.p;
  matches.index_p = matches.index_q = {0, 1};
  matches.weight = {1, 0.5f};
  return matches;
}

TEST(Fault, PosesAreFiniteAndRigid) {
  Poses poses;
  poses.T_world_segment.resize(2);
  EXPECT_THAT(fault_after(poses, [](Poses& p) { p.T_world_segment[1].translation.x() = infinity; }),
              HasSubstr("a non-finite number"));
  EXPECT_THAT(fault_after(poses, [](Poses& p) { p.T_world_segment[0].rotation.w() = nan; }),
              HasSubstr("non-finite"));
  EXPECT_THAT(
      fault_after(poses, [](Poses& p) { p.T_world_segment[0].rotation.coeffs().setZero(); }),
      HasSubstr("rotation is none"));
  EXPECT_THAT(fault_after(poses, [](Poses& p) { p.T_world_segment[0].rotation.coeffs() *= 3; }),
              HasSubstr("rotation is none"));
}

TEST(Fault, TrajectoriesHaveAStampForEachPose) {
  Trajectory trajectory;
  trajectory.stamps = {0, 1}, trajectory.T_world_frame.resize(2);
  EXPECT_THAT(fault_after(trajectory, [](Trajectory& t) { t.stamps.push_back(2); }),
              HasSubstr("as many stamps as poses"));
  EXPECT_THAT(fault_after(trajectory, [](Trajectory& t) { t.stamps[1] = infinity; }),
              HasSubstr("non-finite stamp"));
  EXPECT_THAT(
      fault_after(trajectory, [](Trajectory& t) { t.T_world_frame[1].translation.y() = nan; }),
      HasSubstr("non-finite"));
}

TEST(Fault, RangesHaveAPoseForEachFrame) {
  EXPECT_THAT(fault_after(sound_range(), [](FrameRange& r) { r.end = 3; }),
              HasSubstr("range of frames"));
  EXPECT_THAT(fault_after(sound_range(), [](FrameRange& r) { r.end = 4'000'000'000u; }),
              HasSubstr("range of frames"));
  EXPECT_THAT(fault_after(sound_range(), [](FrameRange& r) { r.T_segment_frame.pop_back(); }),
              HasSubstr("range of frames"));
}

TEST(Fault, CloudsHaveColumnsOfOneLength) {
  const Frame frame{0, full_cloud(3)};
  EXPECT_THAT(fault_after(frame, [](Frame& f) { f.cloud.y.pop_back(); }), HasSubstr("columns"));
  EXPECT_THAT(fault_after(frame, [](Frame& f) { f.cloud.ring.push_back(1); }),
              HasSubstr("columns"));
  EXPECT_THAT(fault_after(frame, [](Frame& f) { f.cloud.nz.clear(); }), HasSubstr("columns"));
  EXPECT_EQ(fault_after(frame, [](Frame& f) { f.cloud.time.clear(); }), "");
  EXPECT_EQ(fault_after(frame, [](Frame& f) { f.cloud.x[0] = nan; }), "")
      << "a sensor may give what is no number";
}

TEST(Fault, SegmentsNameFramesThatTheyHave) {
  EXPECT_THAT(fault_after(sound_segment(), [](Segment& s) { s.frame[2] = 3; }),
              HasSubstr("frame that its segment does not have"));
  EXPECT_THAT(fault_after(sound_segment(), [](Segment& s) { s.frame.pop_back(); }),
              HasSubstr("name a frame for each point"));
  EXPECT_THAT(fault_after(sound_segment(), [](Segment& s) { s.cloud.z[3] = nan; }),
              HasSubstr("point with a non-finite coordinate"));
  EXPECT_THAT(fault_after(sound_segment(), [](Segment& s) { s.cloud.nx[3] = nan; }),
              HasSubstr("normal with a non-finite coordinate"));
  EXPECT_THAT(fault_after(sound_segment(), [](Segment& s) { s.box.high.x() = 1; }),
              HasSubstr("box or centroid"));
  EXPECT_THAT(fault_after(sound_segment(),
                          [](Segment& s) { s.box.low.x() = -static_cast<float>(infinity); }),
              HasSubstr("box or centroid"));
  EXPECT_EQ(fault_after(sound_segment(), [](Segment& s) { s = s.selected({}); }), "");
}

TEST(Fault, EdgesJoinSegmentsThatThereAreInOrder) {
  Edges edges;
  edges.segments = 4;
  edges.list = {{0, 1}, {0, 2}, {2, 3}};
  EXPECT_THAT(fault_after(edges, [](Edges& e) { e.list[1].j = 4; }),
              HasSubstr("segments that there are not"));
  EXPECT_THAT(fault_after(edges, [](Edges& e) { e.segments = 3; }),
              HasSubstr("segments that there are not"));
  EXPECT_THAT(fault_after(edges, [](Edges& e) { e.list[2].i = 3; }), HasSubstr("with itself"));
  EXPECT_THAT(fault_after(edges, [](Edges& e) { e.list[1].j = 1; }), HasSubstr("each pair once"));
  EXPECT_THAT(fault_after(edges, [](Edges& e) { e.list[0].kind = static_cast<EdgeKind>(9); }),
              HasSubstr("kind that there is not"));
  EXPECT_THAT(fault_after(edges, [](Edges& e) { e.list[0].score = nan; }), HasSubstr("non-finite"));
}

TEST(Fault, MatchesAndFeaturesHaveColumnsOfOneLength) {
  EXPECT_THAT(fault_after(sound_matches(), [](Matches& m) { m.q.pop_back(); }),
              HasSubstr("columns"));
  EXPECT_THAT(fault_after(sound_matches(), [](Matches& m) { m.weight.pop_back(); }),
              HasSubstr("columns"));
  EXPECT_THAT(fault_after(sound_matches(), [](Matches& m) { m.weight[0] = nan; }),
              HasSubstr("weight"));
  EXPECT_THAT(fault_after(sound_matches(), [](Matches& m) { m.p[0].x() = nan; }),
              HasSubstr("point"));
  EXPECT_EQ(fault_after(sound_matches(), [](Matches& m) { m = Matches(); }), "");
  Features features;
  features.dimension = 2, features.points.resize(2, {0, 0, 0}), features.vectors = {1, 2, 3, 4};
  EXPECT_THAT(fault_after(features, [](Features& f) { f.dimension = 33; }), HasSubstr("columns"));
  EXPECT_THAT(fault_after(features, [](Features& f) { f.at_border = {1}; }), HasSubstr("columns"));
  EXPECT_THAT(fault_after(features, [](Features& f) { f.vectors[3] = nan; }), HasSubstr("feature"));
}

TEST(Fault, GridsHaveTheCellsThatTheySay) {
  GridMap map;
  map.resolution = 0.1, map.columns = 2, map.rows = 3, map.log_odds.resize(6);
  EXPECT_THAT(fault_after(map, [](GridMap& m) { m.rows = 4; }), HasSubstr("as many cells"));
  EXPECT_THAT(fault_after(map, [](GridMap& m) { m.columns = 0x80000000u, m.rows = 2; }),
              HasSubstr("as many cells"));
  EXPECT_THAT(fault_after(map, [](GridMap& m) { m.resolution = 0; }), HasSubstr("cell size"));
}

TEST(Fault, ConstraintsAndRegistrationsAreFinite) {
  Constraints constraints;
  constraints.relative.resize(1), constraints.absolute.resize(1), constraints.points.resize(1);
  EXPECT_THAT(
      fault_after(constraints, [](Constraints& r) { r.relative[0].information(0, 3) = nan; }),
      HasSubstr("information"));
  EXPECT_THAT(fault_after(constraints,
                          [](Constraints& r) { r.absolute[0].T_world_i.translation.z() = nan; }),
              HasSubstr("pose"));
  EXPECT_THAT(fault_after(constraints, [](Constraints& r) { r.points[0].p_world.x() = infinity; }),
              HasSubstr("point"));
  EXPECT_THAT(fault_after(Registration(), [](Registration& r) { r.information(5, 5) = infinity; }),
              HasSubstr("information"));
}

TEST(Fault, IsFoundByTheTypeOfAnyValue) {
  Edges edges;
  edges.list = {{0, 1}};  // of no segment
  const AnyValue value = any_value(edges);
  EXPECT_THAT(value.type->code->fault(value.value.get()), HasSubstr("segments that there are not"));
}

}  // namespace
}  // namespace plumb
