#include <gmock/gmock.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "refine.hpp"

namespace plumb::refine_frames {
namespace {

using testing::HasSubstr;

struct Point {
  Eigen::Vector3d p, n;
};
using Surfaces = std::vector<Point>;

/// A rectangle of the plane through `origin`, a point each `spacing` [m] along u and v.
void add_plane(Surfaces& surfaces, const Eigen::Vector3d& origin, const Eigen::Vector3d& u,
               const Eigen::Vector3d& v, double spacing) {
  const Eigen::Vector3d normal = u.cross(v).normalized();
  for (double a = 0; a <= u.norm() + 1e-9; a += spacing)
    for (double b = 0; b <= v.norm() + 1e-9; b += spacing)
      surfaces.push_back({origin + a * u.normalized() + b * v.normalized(), normal});
}
/// A corner: the floor and two walls of 8 m, 4 m high. `margin` [m] keeps points away from where
/// planes meet.
Surfaces corner(double spacing, double margin) {
  Surfaces s;
  const double m = margin;
  add_plane(s, {-4 + m, -4 + m, 0}, {8 - 2 * m, 0, 0}, {0, 8 - 2 * m, 0}, spacing);
  add_plane(s, {4, -4 + m, m}, {0, 8 - 2 * m, 0}, {0, 0, 4 - m}, spacing);
  add_plane(s, {-4 + m, 4, m}, {0, 0, 4 - m}, {8 - 2 * m, 0, 0}, spacing);
  return s;
}
Segment seen_as_segment(const Surfaces& surfaces, const Pose& T_world_segment) {
  Cloud cloud;
  const Pose back = T_world_segment.inverse();
  for (const auto& s : surfaces) {
    cloud.add((back * s.p).cast<float>());
    const Eigen::Vector3f n = (back.rotation * s.n).cast<float>();
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  }
  std::vector<std::uint16_t> frames(cloud.size(), 0);
  return Segment().with(std::move(cloud), std::move(frames));
}
Cloud seen_by_frame(const Surfaces& surfaces, const Pose& T_world_frame) {
  Cloud cloud;
  for (const auto& s : surfaces) cloud.add((T_world_frame.inverse() * s.p).cast<float>());
  return cloud;
}
Target target_of(const Surfaces& surfaces, const Pose& T_world_segment = Pose()) {
  return {std::make_shared<Segment>(seen_as_segment(surfaces, T_world_segment)), T_world_segment};
}
double distance(const Pose& a, const Pose& b) { return (a.translation - b.translation).norm(); }
double turn(const Pose& a, const Pose& b) { return angle(a.inverse() * b); }

const Pose truth(exp_rotation({0.02, -0.03, 0.8}), {0.5, -0.4, 1.2});
const Pose off(exp_rotation({0.01, -0.008, 0.015}), {0.15, -0.12, 0.08});

/// The frame's pose hardly holds it.
FrameOptions loose() {
  FrameOptions options;
  options.translation_sigma = 10;
  options.rotation_sigma = 1;
  options.max_iterations = 20;
  return options;
}

TEST(RefineFrame, PutsAFrameBackOntoTheSurfacesThatItSaw) {
  const Pose T_world_segment(exp_rotation({0, 0.1, -2}), {3, 1, 0});
  const Cloud cloud = seen_by_frame(corner(0.31, 0.4), truth);
  FrameOptions all = loose();
  all.max_points = 100000;
  const auto pose =
      registered(cloud, truth * off, {target_of(corner(0.1, 0), T_world_segment)}, all);
  EXPECT_LT(distance(pose.T_world_frame, truth), 1e-3);
  EXPECT_LT(turn(pose.T_world_frame, truth), 3e-4);
  EXPECT_GT(pose.pairs, cloud.size() * 9 / 10);
}

TEST(RefineFrame, FindsTheSameAtUtmCoordinates) {
  const Pose utm(exp_rotation({0, 0, 1}), {412345.6, 5654321.2, 180});
  const Cloud cloud = seen_by_frame(corner(0.31, 0.4), truth);
  const Target here = target_of(corner(0.1, 0));
  const auto near_origin = registered(cloud, truth * off, {here}, {});
  const auto far =
      registered(cloud, utm * truth * off, {{here.segment, utm * here.T_world_segment}}, {});
  EXPECT_LT(distance(far.T_world_frame, utm * near_origin.T_world_frame), 1e-4);
  EXPECT_LT(turn(far.T_world_frame, utm * near_origin.T_world_frame), 1e-5);
}

TEST(RefineFrame, LeavesADirectionAloneThatItsPointsDoNotSee) {
  Surfaces corridor, seen;
  for (auto* s : {&corridor, &seen}) {  // 2 m wide; the frame sees its middle part
    const double half = s == &corridor ? 12 : 6, spacing = s == &corridor ? 0.1 : 0.37;
    add_plane(*s, {-half, -0.7, 0}, {2 * half, 0, 0}, {0, 1.4, 0}, spacing);
    add_plane(*s, {-half, -1, 0.3}, {0, 0, 1.5}, {2 * half, 0, 0}, spacing);
    add_plane(*s, {-half, 1, 0.3}, {2 * half, 0, 0}, {0, 0, 1.5}, spacing);
  }
  const Pose start(Eigen::Quaterniond::Identity(), {0.2, 0.06, -0.05});  // 0.2 m along the corridor
  const auto pose =
      registered(seen_by_frame(seen, Pose()), start, {target_of(corridor)}, loose()).T_world_frame;
  EXPECT_NEAR(pose.translation.x(), 0.2, 1e-3);
  EXPECT_NEAR(pose.translation.y(), 0, 2e-3);
  EXPECT_NEAR(pose.translation.z(), 0, 2e-3);
}

TEST(RefineFrame, StopsBetweenItsPoseAndTheSurfacesByTheirWeights) {
  // A floor of many points, together max_weight / noise^2 firm, and the frame 0.2 m above it: z is
  // the mean of both by their information.
  Surfaces floor, seen;
  add_plane(floor, {-6, -6, 0}, {12, 0, 0}, {0, 12, 0}, 0.1);
  add_plane(seen, {-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 0.25);
  const Pose start(Eigen::Quaterniond::Identity(), {0, 0, 0.2});
  for (const double sigma : {0.005, 0.01, 0.02}) {
    FrameOptions options;
    options.max_points = 100000;
    options.translation_sigma = sigma;
    const double surface = options.max_weight / (options.noise * options.noise),
                 prior = 1 / (sigma * sigma);
    const auto pose =
        registered(seen_by_frame(seen, Pose()), start, {target_of(floor)}, options).T_world_frame;
    EXPECT_NEAR(pose.translation.z(), 0.2 * prior / (prior + surface), 1e-4) << sigma;
    EXPECT_LT(turn(pose, start), 1e-4);
  }
}

TEST(RefineFrame, SettlesBetweenTargetsThatDisagree) {
  Surfaces floor, seen;
  add_plane(floor, {-6, -6, 0}, {12, 0, 0}, {0, 12, 0}, 0.1);
  add_plane(seen, {-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 0.25);
  const Target low = target_of(floor);
  const Pose higher(Eigen::Quaterniond::Identity(), {0, 0, 0.1});
  const auto pose =
      registered(seen_by_frame(seen, Pose()), {Eigen::Quaterniond::Identity(), {0, 0, 0.08}},
                 {low, {low.segment, higher}}, loose());
  EXPECT_NEAR(pose.T_world_frame.translation.z(), 0.05, 2e-3);
  EXPECT_GT(pose.pairs, 1000u) << "each point counts once for each target";
}

TEST(RefineFrame, StaysWhereItFindsFewerThanThirtyPairs) {
  const Pose start = truth * off;
  Surfaces few = corner(0.31, 0.4);
  few.resize(29);
  const auto pose =
      registered(seen_by_frame(few, truth), start, {target_of(corner(0.1, 0))}, loose());
  EXPECT_LT(pose.pairs, 30u);
  EXPECT_EQ(pose.T_world_frame.translation, start.translation);
  const Cloud cloud = seen_by_frame(corner(0.31, 0.4), truth);
  EXPECT_EQ(registered(cloud, start, {}, loose()).pairs, 0u);
  EXPECT_EQ(registered(cloud, start, {{std::make_shared<Segment>(), Pose()}}, loose()).pairs, 0u);
  EXPECT_EQ(registered({}, start, {target_of(corner(0.1, 0))}, loose()).T_world_frame.translation,
            start.translation);
}

TEST(RefineFrame, LeavesOutPointsOfUnknownNormal) {
  Segment unknown = seen_as_segment(corner(0.1, 0), Pose());
  std::ranges::fill(unknown.cloud.nx, 0.0f), std::ranges::fill(unknown.cloud.ny, 0.0f),
      std::ranges::fill(unknown.cloud.nz, 0.0f);
  EXPECT_EQ(registered(seen_by_frame(corner(0.31, 0.4), truth), truth,
                       {{std::make_shared<Segment>(unknown), Pose()}}, loose())
                .pairs,
            0u);
}

TEST(RefineFrame, AsksNoMoreThanTheMostPoints) {
  FrameOptions options = loose();
  options.max_points = 200;
  const auto pose = registered(seen_by_frame(corner(0.1, 0.4), truth), truth * off,
                               {target_of(corner(0.1, 0))}, options);
  EXPECT_LE(pose.pairs, 200u);
  EXPECT_LT(distance(pose.T_world_frame, truth), 5e-3);
}

// ---- the step
// ---------------------------------------------------------------------------------------------------------------------

/// Three segments of two frames each in one corner. The frames of the middle one stand off, and its
/// own cloud with them.
struct Walk {
  Trajectory straight, trajectory;
  std::vector<Frame> frames;
  std::vector<Segment> segments;
  Poses poses;

  Walk() {
    for (int f = 0; f < 6; ++f) {
      const Pose pose(exp_rotation({0, 0, 0.1 * f}), {0.3 * f - 1, -0.2 * f, 1});
      straight.stamps.push_back(f);
      straight.T_world_frame.push_back(pose);
      frames.push_back({static_cast<std::uint32_t>(f), seen_by_frame(corner(0.31, 0.4), pose)});
    }
    trajectory = straight;
    const Pose shift(Eigen::Quaterniond::Identity(), {0.1, -0.08, 0.06});
    for (int f = 2; f < 4; ++f) trajectory.T_world_frame[f] = shift * straight.T_world_frame[f];
    for (std::uint32_t s = 0; s < 3; ++s) {
      poses.T_world_segment.push_back(straight.T_world_frame[2 * s + 1]);
      auto surfaces = corner(0.1, 0);
      if (s == 1)
        for (auto& point : surfaces) point.p = shift * point.p;
      segments.push_back(seen_as_segment(surfaces, poses.T_world_segment[s]));
      segments[s].range.first = 2 * s, segments[s].range.end = 2 * s + 2;
    }
  }
  StepUnderTest step() const {
    StepUnderTest run(*plumb_module());
    run.with("trajectory", trajectory)
        .each("frames", frames)
        .each("segments", segments)
        .with("poses", poses);
    run.set("translation_sigma", 10.0).set("rotation_sigma", 1.0);
    return run;
  }
  Trajectory refined(TestContext& context) const {
    return step().run<Trajectory>("trajectory", context);
  }
  std::string refusal() const {
    TestContext context;
    return io::refusal([&] { refined(context); });
  }
};

TEST(RefineFrames, RegistersAFrameToTheSegmentsRoundItsOwnAndNotToThatOne) {
  const Walk walk;
  TestContext context;
  const auto refined = walk.refined(context);
  for (int f = 2; f < 4; ++f) {
    EXPECT_GT(distance(walk.trajectory.T_world_frame[f], walk.straight.T_world_frame[f]), 0.1);
    EXPECT_LT(distance(refined.T_world_frame[f], walk.straight.T_world_frame[f]), 2e-3);
  }
  EXPECT_EQ(refined.stamps, walk.trajectory.stamps);
  EXPECT_EQ(context.counts["frames left in place for seeing too little of the segments around"],
            0u);
}

TEST(RefineFrames, SeesNoFartherThanTheNeighbours) {
  Walk walk;  // the middle segment gone, and the first and the third two apart
  walk.segments[1] = Segment();
  walk.segments[1].range.first = 2, walk.segments[1].range.end = 4;
  walk.trajectory.T_world_frame[0].translation.z() += 0.1;
  TestContext context;
  const auto one =
      walk.step().set("neighbours", std::int64_t(1)).run<Trajectory>("trajectory", context);
  EXPECT_EQ(one.T_world_frame[0].translation, walk.trajectory.T_world_frame[0].translation);
  EXPECT_EQ(context.counts["frames left in place for seeing too little of the segments around"],
            4u);
  const auto two =
      walk.step().set("neighbours", std::int64_t(2)).run<Trajectory>("trajectory", context);
  EXPECT_LT(distance(two.T_world_frame[0], walk.straight.T_world_frame[0]), 2e-3);
}

TEST(RefineFrames, LeavesTheFramesOfOneSegmentAloneWhereTheyWereAndCountsThem) {
  Walk walk;
  walk.segments.resize(1);
  walk.poses.T_world_segment.resize(1);
  TestContext context;
  const auto refined = walk.refined(context);
  for (int f = 0; f < 6; ++f)
    EXPECT_EQ(refined.T_world_frame[f].translation, walk.trajectory.T_world_frame[f].translation);
  EXPECT_EQ(context.counts["frames left in place for seeing too little of the segments around"],
            2u);
}

TEST(RefineFrames, RefusesFramesPosesAndSegmentsThatDoNotBelongTogether) {
  Walk frames, poses, range;
  frames.frames.pop_back();
  poses.poses.T_world_segment.pop_back();
  range.segments[2].range.end = 7;
  EXPECT_THAT(frames.refusal(), HasSubstr("3 segments, 3 poses, 5 frames and a trajectory of 6"));
  EXPECT_THAT(poses.refusal(), HasSubstr("2 poses"));
  EXPECT_THAT(range.refusal(), HasSubstr("segment 2 has frames that the trajectory does not have"));
  EXPECT_EQ(Walk().refusal(), "(nothing was refused)");
}

TEST(RefineFrames, RefusesSegmentsWithoutNormalsAndNamesTheCure) {
  Walk walk;
  for (auto& segment : walk.segments)
    segment.cloud.nx.clear(), segment.cloud.ny.clear(), segment.cloud.nz.clear();
  EXPECT_THAT(walk.refusal(), HasSubstr("estimate.normals"));
}

TEST(RefineFrames, MultipliesTheDistanceOfACorrespondenceByAScale) {
  const Walk walk;  // frames stand 0.14 m off
  const auto error = [&](double scale) {
    TestContext context;
    auto step = walk.step()
                    .set("max_correspondence_distance", 0.02)
                    .set("final_max_correspondence_distance", 0.02);
    step.with("scale", Metrics().add("scale", scale, ""));
    return distance(step.run<Trajectory>("trajectory", context).T_world_frame[2],
                    walk.straight.T_world_frame[2]);
  };
  EXPECT_GT(error(1), 0.05);
  EXPECT_LT(error(20), 2e-3);
}

}  // namespace
}  // namespace plumb::refine_frames
