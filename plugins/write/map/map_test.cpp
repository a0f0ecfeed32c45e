#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "map_file.hpp"
#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/step.hpp"
#include "shared/parallel/loop_testing.hpp"
#include "voxel_map.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::write_map {
namespace {

Cloud random_cloud(std::uint64_t seed, int points, double size) {
  Random random(seed);
  Cloud cloud;
  for (int k = 0; k < points; ++k) {
    const auto u = [&] { return static_cast<float>(size * (random.uniform() - 0.5)); };
    const float x = u(), y = u(), z = u();
    cloud.add({x, y, z});
  }
  return cloud;
}

/// Adds one frame. Tiles that it does not meet are closed.
void add_all(VoxelMap& map, const Cloud& cloud, const Pose& pose) {
  const auto cells = map.cells_of(cloud, pose);
  map.add({&cells, 1}, parallel::in_order, 1);
}

/// The points that the map writes.
std::vector<Eigen::Vector3f> taken(VoxelMap& map) {
  FileBytes made;
  map.write(made);
  const std::string bytes = made.text();
  std::vector<Eigen::Vector3f> points(bytes.size() / 12);
  std::memcpy(static_cast<void*>(points.data()), bytes.data(), bytes.size());
  return points;
}

using Cell = std::array<long, 3>;
Cell cell_of(const Eigen::Vector3d& p, double voxel_size) {
  return {std::lround(std::floor(p.x() / voxel_size)), std::lround(std::floor(p.y() / voxel_size)),
          std::lround(std::floor(p.z() / voxel_size))};
}

TEST(VoxelMap, HoldsTheMeanOfEachCellAsAMapOfCellsDoes) {
  VoxelMap map(0.5, Eigen::Vector3d::Zero());
  std::map<Cell, std::pair<Eigen::Vector3d, int>> expected;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto cloud = random_cloud(seed, 4000, 30);
    // To and fro, so that tiles are closed and opened again.
    const Pose pose(exp_rotation({0.1, 0.2, 0.3 * static_cast<double>(seed)}),
                    {seed % 2 ? 15.0 : -15.0, -3, 1});
    add_all(map, cloud, pose);
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      const Eigen::Vector3d p = pose * cloud.point(k).cast<double>().eval();
      auto& [sum, n] =
          expected.try_emplace(cell_of(p, 0.5), Eigen::Vector3d::Zero(), 0).first->second;
      sum += p, ++n;
    }
  }
  ASSERT_NEAR(static_cast<double>(map.size()), static_cast<double>(expected.size()), 2);
  ASSERT_LT(map.open(), map.size()) << "the test sees no tile closed";
  for (const auto& point : taken(map)) {
    const Eigen::Vector3d p = point.cast<double>();
    const auto at = expected.find(cell_of(p, 0.5));
    ASSERT_NE(at, expected.end());
    EXPECT_LT((at->second.first / at->second.second - p).norm(), 2e-5);
  }
}

TEST(VoxelMap, KeepsMillimetresAtUtmCoordinates) {
  const Eigen::Vector3d utm(412345.678, 5654321.123, 87.6);
  VoxelMap map(0.2, {412000, 5654000, 0});
  Cloud one;
  one.add({1, 2, 3});
  add_all(map, one, Pose(Eigen::Quaterniond::Identity(), utm));
  const auto points = taken(map);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_LT((points[0].cast<double>() -
             (utm + Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(412000, 5654000, 0)))
                .norm(),
            1e-4);
}

TEST(VoxelMap, TakesMorePointsInACellThanItCanCount) {
  VoxelMap map(1, Eigen::Vector3d::Zero());
  Cloud cloud;
  for (int k = 0; k < 70000; ++k) cloud.add({0.25f, 0.5f, 0.75f});
  add_all(map, cloud, Pose());
  add_all(map, random_cloud(1, 100, 3),
          Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(-200, 0, 0)));  // closes the first
  add_all(map, cloud, Pose());
  EXPECT_LT((taken(map).back() - Eigen::Vector3f(0.25f, 0.5f, 0.75f)).norm(), 1e-4f);
}

TEST(VoxelMap, LeavesOutAndCountsWhatIsTooFar) {
  VoxelMap map(0.01, Eigen::Vector3d::Zero());
  Cloud cloud;
  cloud.add({1, 1, 1});
  cloud.add({20000, 0, 0});
  EXPECT_EQ(map.cells_of(cloud, Pose()).too_far, 1u);
}

TEST(VoxelMap, WritesTheSameWhateverIsAddedAtOnceWheneverTilesAreClosedAndWhereverTheyWait) {
  const auto bytes_of = [](std::size_t together, std::size_t idle, std::size_t memory) {
    VoxelMap map(0.1, Eigen::Vector3d::Zero(), memory);
    std::vector<VoxelMap::FrameCells> frames;
    for (std::uint64_t k = 0; k < 24; ++k) {  // there and back again
      const double way = static_cast<double>(k < 12 ? k : 24 - k);
      frames.push_back(
          map.cells_of(random_cloud(k, 2000, 8),
                       Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(3 * way, 0, 0))));
      if (frames.size() < together && k < 23) continue;
      map.add(frames, parallel::in_order, idle);
      frames.clear();
    }
    FileBytes bytes;
    map.write(bytes);
    return bytes.text();
  };
  const auto expected = bytes_of(24, 1000, 1 << 30);  // nothing is closed
  EXPECT_GT(expected.size(), 12u * 20000);
  for (const std::size_t together : {1, 5, 16})
    for (const std::size_t idle : {0, 1, 7})
      for (const std::size_t memory : {0, 100000, 1 << 30})
        EXPECT_TRUE(bytes_of(together, idle, memory) == expected)
            << together << " " << idle << " " << memory;
}

TEST(VoxelMap, KeepsOpenWhatTheSensorSeesHoweverLongTheWay) {
  const auto most_open = [](int frames) {
    VoxelMap map(0.2, Eigen::Vector3d::Zero());
    std::size_t most = 0;
    for (int k = 0; k < frames; ++k) {
      const auto cells =
          map.cells_of(random_cloud(static_cast<std::uint64_t>(k), 1000, 20),
                       Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(2.0 * k, 0, 0)));
      map.add({&cells, 1}, parallel::in_order, 4);
      most = std::max(most, map.open());
    }
    return static_cast<double>(most);
  };
  EXPECT_LT(most_open(400), 1.2 * most_open(50));
}

TEST(MapOrigin, IsZeroNearAndWholeKilometresFarAway) {
  Trajectory t;
  t.stamps = {0};
  t.T_world_frame = {Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(9000, -50, 3))};
  EXPECT_TRUE(map_origin(t).isZero());
  t.T_world_frame[0].translation = {412345, 5654321, 80};
  EXPECT_EQ(map_origin(t), Eigen::Vector3d(412000, 5654000, 0));
}

struct Frames : Collection {
  std::vector<AnyValue> items;
  std::size_t size() const override { return items.size(); }
  AnyValue open(std::size_t k) const override { return items[k]; }
};

/// The step's document for `frames` random frames that stand 5 m apart from each other, from
/// `start` on.
std::string document(std::size_t frames, const Eigen::Vector3d& start, const std::string& format,
                     Context& context, std::size_t poses) {
  auto each = std::make_shared<Frames>();
  Trajectory trajectory;
  for (std::size_t k = 0; k < frames; ++k)
    each->items.push_back(
        any_value(Frame{static_cast<std::uint32_t>(k), random_cloud(k, 1000, 10)}));
  for (std::size_t k = 0; k < poses; ++k) {
    trajectory.stamps.push_back(static_cast<double>(k));
    trajectory.T_world_frame.push_back(
        {Eigen::Quaterniond::Identity(),
         Eigen::Vector3d(start + Eigen::Vector3d(5.0 * static_cast<double>(k), 0, 0))});
  }
  PortInput inputs[3];
  inputs[0].wired = inputs[1].wired = true;
  inputs[0].each = each;
  inputs[1].one = any_value(trajectory);
  PortOutput output;
  const Step& step = *plumb_module()->steps[0];
  step.run(step.parameters({{"voxel_size", 0.5}, {"format", format}}).get(), inputs, {&output, 1},
           context);
  return output.one.as<Document>()->bytes.text();
}

Cloud read_back(const std::string& bytes, const std::string& extension) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("plumb_map_" + std::to_string(::getpid()) + extension);
  std::ofstream(file, std::ios::binary) << bytes;
  const auto cloud = read_cloud(file).cloud;
  std::filesystem::remove(file);
  return cloud;
}

TEST(WriteMap, WritesTheSameMapAsPlyAndAsPcd) {
  TestContext context;
  const auto ply = read_back(document(40, {0, 0, 0}, "ply", context, 40), ".ply");
  const auto pcd = read_back(document(40, {0, 0, 0}, "pcd", context, 40), ".pcd");
  EXPECT_EQ(context.counts["points read for the map"], 80000u);
  EXPECT_GT(ply.size(), 1000u);
  EXPECT_EQ(ply.x, pcd.x);
  EXPECT_EQ(ply.z, pcd.z);
}

TEST(WriteMap, TellsItsOriginFarFromTheWorlds) {
  TestContext context;
  const auto ply = document(3, {412345, 5654321, 80}, "ply", context, 3);
  EXPECT_THAT(ply.substr(0, 400), testing::HasSubstr("origin 412000 5654000 0: add to"));
  const auto pcd = document(3, {412345, 5654321, 80}, "pcd", context, 3);
  EXPECT_THAT(pcd.substr(0, 400), testing::HasSubstr("# origin 412000 5654000 0: add to"));
  EXPECT_LT(box_of(read_back(ply, ".ply")).high.norm(), 1000);
  EXPECT_EQ(read_back(pcd, ".pcd").size(), read_back(ply, ".ply").size());
}

TEST(WriteMap, GivesTheSameBytesInAnyOrderOfWorkAndForAnyNumberOfThreads) {
  TestContext forwards;
  parallel::BackwardsContext backwards;
  parallel::ThreadedContext threads;
  const auto expected = document(100, {0, 0, 0}, "ply", forwards, 100);
  EXPECT_TRUE(document(100, {0, 0, 0}, "ply", backwards, 100) == expected);
  EXPECT_TRUE(document(100, {0, 0, 0}, "ply", threads, 100) == expected);
}

TEST(WriteMap, RefusesATrajectoryOfOtherFrames) {
  TestContext context;
  EXPECT_THROW(document(3, {0, 0, 0}, "ply", context, 4), Error);
}

}  // namespace
}  // namespace plumb::write_map
