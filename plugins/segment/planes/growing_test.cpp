#include "growing.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"

namespace plumb::segment_planes {
namespace {

/// Points with normals, and on which wall each was put.
struct Room {
  Cloud cloud;
  std::vector<std::uint32_t> wall;  ///< 0: on none
  Random random;

  explicit Room(std::uint64_t seed) : random(seed) {}
  /// A rectangle from `corner`, spanned by u and v, with points every 0.2 m and `noise` [m].
  void add_wall(std::uint32_t name, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                const Eigen::Vector3d& v, double noise) {
    const Eigen::Vector3d normal = u.cross(v).normalized();
    for (double a = 0.1; a < u.norm(); a += 0.2)
      for (double b = 0.1; b < v.norm(); b += 0.2)
        add(corner + a * u.normalized() + b * v.normalized() +
                noise * (2 * random.uniform() - 1) * normal,
            normal, name);
  }
  void add_clutter(int count, double side) {
    const auto draw = [&] { return 2 * random.uniform() - 1; };
    for (int k = 0; k < count; ++k) {
      const double x = draw(), y = draw(), z = draw(), a = draw(), b = draw(), c = draw();
      add({side * x, side * y, 2 + z}, Eigen::Vector3d(a, b, c + 1e-3).normalized(), 0);
    }
  }
  Segment segment() const {
    Segment from;
    from.range.end = 1;
    from.range.T_segment_frame = {Pose(Eigen::Quaterniond::Identity(), {0, 0, 2})};
    return from.with(cloud, std::vector<std::uint16_t>(cloud.size(), 0));
  }

 private:
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, std::uint32_t name) {
    cloud.add(p.cast<float>());
    cloud.nx.push_back(static_cast<float>(normal.x()));
    cloud.ny.push_back(static_cast<float>(normal.y()));
    cloud.nz.push_back(static_cast<float>(normal.z()));
    wall.push_back(name);
  }
};

/// A floor of 10 m x 8 m, two walls 3 m high that meet, and clutter.
Room corner_of_a_room(double noise = 0.01) {
  Room room(1);
  room.add_wall(1, {-5, -4, 0}, {10, 0, 0}, {0, 8, 0}, noise);
  room.add_wall(2, {-5, 4, 0.3}, {10, 0, 0}, {0, 0, 3}, noise);
  room.add_wall(3, {5, -4, 0.3}, {0, 8, 0}, {0, 0, 3}, noise);
  room.add_clutter(200, 3);
  return room;
}

TEST(GrowPlanes, FindsTheWallsAndTheFloorOfARoom) {
  const Room room = corner_of_a_room();
  const Planes found = grow_planes(room.segment(), {});
  ASSERT_EQ(found.planes.size(), 3u);
  const Eigen::Vector3f normals[] = {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}};  // to the sensor inside
  const float offsets[] = {0, -4, -5};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GT(found.planes[k].normal.dot(normals[k]), std::cos(0.3 * deg)) << k;
    EXPECT_NEAR(found.planes[k].offset, offsets[k], 0.02) << k;
    EXPECT_LT(found.planes[k].rms, 0.02f) << k;
  }
  std::size_t right = 0, walls = 0, clutter = 0;
  for (std::size_t k = 0; k < room.wall.size(); ++k) {
    walls += room.wall[k] > 0;
    right += room.wall[k] > 0 && found.label[k] == room.wall[k];
    clutter += room.wall[k] == 0 && found.label[k] > 0;
  }
  EXPECT_GE(right, walls * 99 / 100);
  EXPECT_LT(clutter, 10u);
}

TEST(GrowPlanes, AreFitsOfTheirPointsWithinTheDistanceAndInOrderOfTheirSize) {
  const Room room = corner_of_a_room(0.04);
  const Segment segment = room.segment();
  GrowingOptions options;
  options.max_plane_distance = 0.06;
  const Planes found = grow_planes(segment, options);
  ASSERT_GE(found.planes.size(), 3u);
  std::vector<double> squares(found.planes.size(), 0);
  std::vector<std::uint32_t> points(found.planes.size(), 0);
  for (std::size_t k = 0; k < segment.cloud.size(); ++k) {
    if (found.label[k] == 0) continue;
    const Plane& plane = found.planes[found.label[k] - 1];
    const double distance = plane.normal.dot(segment.cloud.point(k)) - plane.offset;
    // A point is held against the plane of the round before, which is nearly that of the end.
    EXPECT_LT(std::abs(distance), 0.07);
    squares[found.label[k] - 1] += distance * distance;
    ++points[found.label[k] - 1];
  }
  for (std::size_t n = 0; n < found.planes.size(); ++n) {
    EXPECT_EQ(found.planes[n].points, points[n]);
    EXPECT_NEAR(found.planes[n].rms, std::sqrt(squares[n] / points[n]), 1e-4);
    if (n > 0) {
      EXPECT_GE(points[n - 1], points[n]);
    }
  }
}

TEST(GrowPlanes, KeepsStepsApartThatAreHigherThanTheDistance) {
  Room room(2);
  room.add_wall(1, {0, 0, 0}, {6, 0, 0}, {0, 4, 0}, 0.005);
  room.add_wall(2, {6, 0, 0.3}, {5, 0, 0}, {0, 4, 0}, 0.005);
  EXPECT_EQ(grow_planes(room.segment(), {}).planes.size(), 2u);
  GrowingOptions coarse;
  coarse.max_plane_distance = 0.5;
  EXPECT_EQ(grow_planes(room.segment(), coarse).planes.size(), 1u);
}

TEST(GrowPlanes, DoesNotCareForTheSignsOfNormals) {
  const Room room = corner_of_a_room();
  Segment segment = room.segment();
  const Planes before = grow_planes(segment, {});
  for (std::size_t k = 0; k < segment.cloud.size(); k += 3)
    segment.cloud.nx[k] *= -1, segment.cloud.ny[k] *= -1, segment.cloud.nz[k] *= -1;
  EXPECT_EQ(grow_planes(segment, {}).label, before.label);
}

TEST(GrowPlanes, OfNothingAndOfPointsWithoutNormalsAreNone) {
  EXPECT_TRUE(grow_planes(Segment(), {}).planes.empty());
  Room room = corner_of_a_room();
  std::fill(room.cloud.nx.begin(), room.cloud.nx.end(), 0.f);
  std::fill(room.cloud.ny.begin(), room.cloud.ny.end(), 0.f);
  std::fill(room.cloud.nz.begin(), room.cloud.nz.end(), 0.f);
  const Planes none = grow_planes(room.segment(), {});
  EXPECT_TRUE(none.planes.empty());
  EXPECT_EQ(none.label, std::vector<std::uint32_t>(room.cloud.size(), 0));
}

TEST(PlanesType, HasNoPlaneThatIsNotThere) {
  using Traits = TypeTraits<Planes>;
  Planes planes;
  planes.planes.resize(2);
  planes.label = {0, 1, 2};
  EXPECT_STREQ(Traits::fault(planes), "");
  planes.label.push_back(3);
  EXPECT_STREQ(Traits::fault(planes), "a point on a plane that there is not");
  planes.label.pop_back();
  planes.planes[1].normal.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_STREQ(Traits::fault(planes), "a plane with a non-finite number");
}

TEST(SegmentPlanes, KeepsThePointsOnPlanesWithTheirNormals) {
  const Room room = corner_of_a_room();
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("segment", room.segment());
  const auto planes = step.run<Planes>("planes", context);
  context.counts.clear();
  const auto kept = step.run<Segment>("segment", context);
  const auto on_one = static_cast<std::size_t>(
      std::ranges::count_if(planes.label, [](auto label) { return label > 0; }));
  EXPECT_EQ(kept.cloud.size(), on_one);
  EXPECT_EQ(context.counts["planes"], 3u);
  EXPECT_EQ(context.counts["points on no plane dropped"], room.cloud.size() - on_one);
  std::set<std::array<float, 3>> normals;
  for (std::size_t k = 0; k < kept.cloud.size(); ++k) {
    normals.insert({kept.cloud.nx[k], kept.cloud.ny[k], kept.cloud.nz[k]});
    EXPECT_GE(kept.cloud.normal(k).dot(kept.origin(k) - kept.cloud.point(k)), 0);
  }
  EXPECT_EQ(normals.size(), 3u);
}

TEST(SegmentPlanes, SaysThatItNeedsNormals) {
  Room room = corner_of_a_room();
  room.cloud.nx.clear(), room.cloud.ny.clear(), room.cloud.nz.clear();
  TestContext context;
  StepUnderTest step(*plumb_module());
  step.with("segment", room.segment());
  try {
    step.run<Segment>("segment", context);
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("estimate.normals"));
  }
  step.with("segment", Segment());
  EXPECT_EQ(step.run<Segment>("segment", context).cloud.size(), 0u);
}

}  // namespace
}  // namespace plumb::segment_planes
