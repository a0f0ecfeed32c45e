#include "occupancy.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "plumb/plugin/step_testing.hpp"
#include "plumb/slam/step.hpp"
#include "ray.hpp"
#include "shared/parallel/loop_testing.hpp"

namespace plumb::map_occupancy_grid {
namespace {

using parallel::in_order;
using Cells = std::set<std::pair<int, int>>;  // column, row

Cells passed(const Ray& ray, int from = 0, int to = 1000) {
  Cells cells;
  traverse(ray, from, to, [&](int r, int first, int last) {
    for (int c = first; c <= last; ++c) EXPECT_TRUE(cells.insert({c, r}).second);
  });
  return cells;
}

/// Length of the part of a ray inside a cell: the second way, by clipping.
double length_in(const Ray& ray, int c, int r) {
  const double dx = double{ray.x1} - ray.x0, dy = double{ray.y1} - ray.y0;
  double enter = 0, leave = 1;
  const auto clip = [&](double from, double d, double low) {
    if (d == 0) {
      if (from < low || from >= low + 1) leave = -1;
      return;
    }
    const double a = (low - from) / d, b = (low + 1 - from) / d;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  clip(ray.x0, dx, c);
  clip(ray.y0, dy, r);
  return (leave - enter) * std::hypot(dx, dy);
}

TEST(Traverse, PassesExactlyTheCellsThatTheRayIsIn) {
  Random random(3);
  for (int n = 0; n < 2000; ++n) {
    const auto at = [&] { return static_cast<float>(25 * random.uniform()); };
    const Ray ray{at(), at(), at(), n % 7 ? at() : 12.5f};
    const Cells cells = passed(ray);
    for (int r = 0; r < 26; ++r)
      for (int c = 0; c < 26; ++c) {
        const double length = length_in(ray, c, r);
        if (length > 1e-4) {
          EXPECT_TRUE(cells.contains({c, r})) << length;
        }
        if (length < -1e-4) {
          EXPECT_FALSE(cells.contains({c, r})) << length;
        }
      }
  }
}

TEST(Traverse, GivesTheSameCellsBandByBand) {
  Random random(5);
  for (int n = 0; n < 500; ++n) {
    const auto at = [&] { return static_cast<float>(40 * random.uniform()); };
    const Ray ray{at(), at(), at(), at()};
    Cells together;
    for (int row = 0; row < 40; row += 7) together.merge(passed(ray, row, row + 6));
    EXPECT_EQ(together, passed(ray));
  }
}

TEST(Traverse, StaysInOneCellForARayWithoutLength) {
  EXPECT_EQ(passed({3.5f, 2.5f, 3.5f, 2.5f}), (Cells{{3, 2}}));
  EXPECT_EQ(passed({1.5f, 2.5f, 4.5f, 2.5f}).size(), 4u);
  EXPECT_EQ(passed({1.5f, 5.5f, 1.5f, 2.5f}).size(), 4u);
}

float at(const GridMap& map, double x, double y) {
  const auto c = static_cast<std::size_t>(std::floor((x - map.origin.x()) / map.resolution));
  const auto r = static_cast<std::size_t>(std::floor((y - map.origin.y()) / map.resolution));
  EXPECT_LT(c, map.columns);
  EXPECT_LT(r, map.rows);
  return map.log_odds[r * map.columns + c];
}

const GridOptions options{.resolution = 0.1,
                          .hit = 1,
                          .miss = 0.5,
                          .min_log_odds = -2,
                          .max_log_odds = 3,
                          .max_range = 20};

TEST(Occupancy, IsFreeUpToAHitOccupiedThereAndUnknownBehind) {
  const auto map = occupancy({{{0.05, 0.05}, {{2.05, 0.05}}}}, options, in_order);
  for (double x = 0.05; x < 2; x += 0.1) EXPECT_EQ(at(map, x, 0.05), -0.5f) << x;
  EXPECT_EQ(at(map, 2.05, 0.05), 1);
  EXPECT_EQ(at(map, 2.15, 0.05), 0);
  EXPECT_EQ(at(map, 1.05, 0.15), 0);
}

TEST(Occupancy, CountsACellOncePerScanAndAHitBeforeAMiss) {
  // Three rays along one line; the middle one ends where the others pass.
  const auto map =
      occupancy({{{0.05, 0.05}, {{2.05, 0.05}, {1.05, 0.05}, {2.05, 0.06}}}}, options, in_order);
  EXPECT_EQ(at(map, 0.55, 0.05), -0.5f);
  EXPECT_EQ(at(map, 1.05, 0.05), 1);
  EXPECT_EQ(at(map, 1.55, 0.05), -0.5f);
  EXPECT_EQ(at(map, 2.05, 0.05), 1);
}

TEST(Occupancy, StaysWithinItsClampsAndForgetsInOrder) {
  const PlacedScan hit{{0.05, 0.05}, {{1.05, 0.05}}}, pass{{0.05, 0.05}, {{2.05, 0.05}}};
  std::vector<PlacedScan> scans(10, hit);
  EXPECT_EQ(at(occupancy(scans, options, in_order), 1.05, 0.05), 3);
  EXPECT_EQ(at(occupancy(scans, options, in_order), 0.55, 0.05), -2);
  for (int k = 0; k < 4; ++k) scans.push_back(pass);
  EXPECT_EQ(at(occupancy(scans, options, in_order), 1.05, 0.05), 1);
}

TEST(Occupancy, TellsASeenCellFromAnUnknownOne) {
  const PlacedScan hit{{0.05, 0.05}, {{1.05, 0.05}}}, pass{{0.05, 0.05}, {{2.05, 0.05}}};
  EXPECT_NE(at(occupancy({hit, pass, pass}, options, in_order), 1.05, 0.05), 0);
}

TEST(Occupancy, ClearsTheWayOfFarHitsOnly) {
  const auto map = occupancy({{{0.05, 0.05}, {{100.05, 0.05}}}}, options, in_order);
  EXPECT_LT(map.columns, 205u);
  EXPECT_EQ(at(map, 19.9, 0.05), -0.5f);
  EXPECT_EQ(std::ranges::count_if(map.log_odds, [](float v) { return v > 0; }), 0);
}

/// Scans inside a square room, from many places.
std::vector<PlacedScan> room(std::size_t count) {
  std::vector<PlacedScan> scans;
  Random random(11);
  for (std::size_t k = 0; k < count; ++k) {
    PlacedScan scan{{8 * random.uniform() - 4, 8 * random.uniform() - 4}, {}};
    for (int b = 0; b < 90; ++b) {
      const Eigen::Vector2d d(std::cos(0.07 * b + 0.01), std::sin(0.07 * b + 0.01));
      const Eigen::Array2d t =
          ((d.array() > 0).select(5.03, Eigen::Array2d::Constant(-5.03)) - scan.from.array()) /
          d.array();
      scan.hits.push_back(scan.from + d * std::abs(t.minCoeff()));
    }
    scans.push_back(scan);
  }
  return scans;
}

TEST(Occupancy, DrawsTheWallsOfARoomAndNothingElse) {
  const auto map = occupancy(room(200), options, in_order);
  int drawn = 0, all = 0;
  for (double s = -4.93; s < 5; s += 0.1)
    for (const double wall : {-5.03, 5.03}) {
      drawn += (at(map, wall, s) > 0) + (at(map, s, wall) > 0);
      all += 2;
      EXPECT_LT(at(map, 0.9 * s, 0.9 * wall), 0);
      EXPECT_LT(at(map, 0.9 * wall, 0.9 * s), 0);
    }
  EXPECT_GT(drawn, 0.98 * all);
  // Nothing but the four corners stands in the room or behind its walls.
  EXPECT_EQ(std::ranges::count_if(map.log_odds, [](float v) { return v > 0; }), drawn + 4);
}

TEST(Occupancy, GivesTheSameBytesInAnyOrderOfWork) {
  const auto scans = room(50);
  EXPECT_EQ(to_bytes(occupancy(scans, options, in_order)),
            to_bytes(occupancy(scans, options, parallel::backwards)));
}

/// The second way: every scan's cells as sets, cell by cell.
TEST(Occupancy, EqualsTheSumOverSetsOfCells) {
  const auto scans = room(30);
  const auto map = occupancy(scans, options, in_order);
  std::map<std::pair<int, int>, float> expected;
  for (const auto& scan : scans) {
    const auto cell = [&](const Eigen::Vector2d& p) -> Eigen::Vector2f {
      return ((p - map.origin) / map.resolution).cast<float>();
    };
    Cells hits, misses;
    for (const auto& hit : scan.hits) {
      const auto a = cell(scan.from), b = cell(hit);
      hits.insert({static_cast<int>(b.x()), static_cast<int>(b.y())});
      misses.merge(passed({a.x(), a.y(), b.x(), b.y()}));
    }
    for (const auto& c : hits) expected[c] = std::min(expected[c] + 1.0f, 3.0f);
    for (const auto& c : misses)
      if (!hits.contains(c)) expected[c] = std::max(expected[c] - 0.5f, -2.0f);
  }
  for (int r = 0; r < static_cast<int>(map.rows); ++r)
    for (int c = 0; c < static_cast<int>(map.columns); ++c)
      EXPECT_NEAR(
          map.log_odds[static_cast<std::size_t>(r) * map.columns + static_cast<std::size_t>(c)],
          (expected.contains({c, r}) ? expected.at({c, r}) : 0.0f), 1e-30);
}

TEST(Occupancy, KeepsItsShapeFarFromTheOrigin) {
  auto scans = room(20);
  const auto near = occupancy(scans, options, in_order);
  for (auto& scan : scans) {
    scan.from += Eigen::Vector2d(400000, 5000000);
    for (auto& hit : scan.hits) hit += Eigen::Vector2d(400000, 5000000);
  }
  const auto far = occupancy(scans, options, in_order);
  std::size_t different = 0;
  ASSERT_EQ(near.log_odds.size(), far.log_odds.size());
  for (std::size_t k = 0; k < near.log_odds.size(); ++k)
    different += (near.log_odds[k] > 0) != (far.log_odds[k] > 0);
  EXPECT_LT(different, near.log_odds.size() / 200);
}

TEST(Occupancy, RefusesWhatDoesNotFit) {
  EXPECT_TRUE(occupancy({}, options, in_order).log_odds.empty());
  EXPECT_THROW(occupancy({{{0, 0}, {}}, {{1e5, 1e5}, {}}}, options, in_order), Error);
  EXPECT_THROW(occupancy({{{0, std::nan("")}, {}}}, options, in_order), Error);
}

TEST(OccupancyGridStep, PlacesFramesByTheirPoses) {
  TestContext context;
  Frame frame;
  frame.cloud.add({1, 0, 0});
  Trajectory trajectory;
  trajectory.stamps = {0, 1};
  trajectory.T_world_frame = {{exp_rotation({0, 0, M_PI / 2}), {3.01, 4.01, 0}},
                              {exp_rotation({0, 0, M_PI / 2}), {4.01, 4.01, 0}}};
  const auto map = StepUnderTest(*plumb_module())
                       .each<Frame>("frames", {frame, frame})
                       .with("trajectory", trajectory)
                       .run<GridMap>("map", context);
  EXPECT_GT(at(map, 3.02, 5.02), 0);
  EXPECT_GT(at(map, 4.02, 5.02), 0);
  EXPECT_LT(at(map, 4.02, 4.52), 0);
  EXPECT_EQ(context.counts["cells occupied"], 2u);
  trajectory.stamps.pop_back();
  EXPECT_THROW(StepUnderTest(*plumb_module())
                   .each<Frame>("frames", {frame, frame})
                   .with("trajectory", trajectory)
                   .run<GridMap>("map", context),
               Error);
}

TEST(SubmapGridStep, DrawsEachSubmapAsAScanFromItsOrigin) {
  // A point 1 m ahead, and one behind it that another scan of the submap saw.
  Cloud cloud;
  cloud.add({1, 0, 0}), cloud.add({2, 0, 0});
  const Segment submap = Segment().with(cloud, {0, 0});
  Poses poses;
  poses.T_world_segment.push_back({exp_rotation({0, 0, M_PI / 2}), {3.01, 4.01, 0}});
  TestContext context;
  StepUnderTest step(*plumb_module(), 1);
  step.each<Segment>("submaps", {submap}).with("poses", poses);
  const auto map = step.run<GridMap>("map", context);
  EXPECT_GT(at(map, 3.02, 5.02), 0);  // the ray to the other point passes it: the hit wins
  EXPECT_GT(at(map, 3.02, 6.02), 0);
  EXPECT_LT(at(map, 3.02, 4.52), 0);
  EXPECT_LT(at(map, 3.02, 5.52), 0);
  EXPECT_EQ(context.counts["cells occupied"], 2u);
  poses.T_world_segment.resize(2);
  EXPECT_THROW(step.with("poses", poses).run<GridMap>("map", context), Error);
}

TEST(SubmapGridStep, OfSingleScansIsTheGridOfTheScans) {
  TestContext context;
  Trajectory trajectory;
  Poses poses;
  std::vector<Frame> frames;
  std::vector<Segment> submaps;
  for (int k = 0; k < 3; ++k) {
    poses.T_world_segment.push_back({exp_rotation({0, 0, 0.3 * k}), {0.4 * k, 0, 0}});
    trajectory.T_world_frame.push_back(poses.T_world_segment.back());
    trajectory.stamps.push_back(k);
    frames.emplace_back();
    for (int n = 0; n < 40; ++n)
      frames.back().cloud.add(
          {4 + std::sin(0.2f * static_cast<float>(n + k)), 0.1f * static_cast<float>(n) - 2, 0});
    submaps.push_back(Segment().with(frames.back().cloud, std::vector<std::uint16_t>(40, 0)));
  }
  const auto of_scans = StepUnderTest(*plumb_module())
                            .each("frames", frames)
                            .with("trajectory", trajectory)
                            .run<GridMap>("map", context);
  const auto of_submaps = StepUnderTest(*plumb_module(), 1)
                              .each("submaps", submaps)
                              .with("poses", poses)
                              .run<GridMap>("map", context);
  EXPECT_EQ(to_bytes(of_scans), to_bytes(of_submaps));
}

}  // namespace
}  // namespace plumb::map_occupancy_grid
