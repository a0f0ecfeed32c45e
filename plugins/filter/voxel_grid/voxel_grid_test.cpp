#include "voxel_grid.hpp"

#include <gmock/gmock.h>

#include <array>
#include <limits>
#include <map>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/module.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/step.hpp"

extern "C" const PlumbModule* plumb_module();

namespace plumb::filter_voxel_grid {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;

Thinned thin(const Cloud& cloud, double voxel_size) {
  return filter_voxel_grid::thin(cloud, {}, {}, voxel_size);
}

Cloud cloud_of(std::initializer_list<Eigen::Vector3f> points) {
  Cloud cloud;
  for (const auto& p : points) cloud.add(p);
  return cloud;
}

Cloud scattered(std::size_t n, double width,
                const Eigen::Vector3f& centre = Eigen::Vector3f::Zero()) {
  Random random(n);
  Cloud cloud;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3d p(random.uniform(), random.uniform(), random.uniform());
    cloud.add((width * (p.array() - 0.5)).matrix().cast<float>() + centre);
    cloud.intensity.push_back(static_cast<float>(random.uniform()));
  }
  return cloud;
}

TEST(VoxelGrid, KeepsTheMeanOfEachCell) {
  const Cloud result = thin(cloud_of({{0.1f, 0.1f, 0.1f}, {5, 5, 5}, {0.3f, 0.5f, 0.1f}}), 1).cloud;
  ASSERT_EQ(result.size(), 2u);
  EXPECT_LT((result.point(0) - Eigen::Vector3f(0.2f, 0.3f, 0.1f)).norm(), 1e-6);
  EXPECT_EQ(result.point(1), Eigen::Vector3f(5, 5, 5));
}

TEST(VoxelGrid, PartsCellsAtMultiplesOfTheLeafAlsoBelowZero) {
  EXPECT_EQ(thin(cloud_of({{-0.1f, 0, 0}, {0.1f, 0, 0}}), 1).cloud.size(), 2u);
  EXPECT_EQ(thin(cloud_of({{-0.1f, 0, 0}, {-0.9f, 0, 0}}), 1).cloud.size(), 1u);
}

TEST(VoxelGrid, AgreesWithASortedMapOfCells) {
  for (const double voxel_size : {0.3, 2.0, 50.0}) {
    const Cloud cloud = scattered(20000, 40, {3, -7, 100});
    std::map<std::array<double, 3>, std::pair<Eigen::Vector4d, int>> cells;
    std::vector<std::array<double, 3>> order;
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      const std::array cell = {std::floor(cloud.x[k] / voxel_size),
                               std::floor(cloud.y[k] / voxel_size),
                               std::floor(cloud.z[k] / voxel_size)};
      auto [at, added] = cells.try_emplace(cell, Eigen::Vector4d::Zero(), 0);
      if (added) order.push_back(cell);
      at->second.first += Eigen::Vector4d(cloud.x[k], cloud.y[k], cloud.z[k], cloud.intensity[k]);
      ++at->second.second;
    }
    const Cloud result = thin(cloud, voxel_size).cloud;
    ASSERT_EQ(result.size(), cells.size());
    for (std::size_t c = 0; c < order.size(); ++c) {
      const auto& [sum, count] = cells[order[c]];
      EXPECT_LT((result.point(c).cast<double>() - sum.head<3>() / count).norm(), 1e-5);
      EXPECT_NEAR(result.intensity[c], sum[3] / count, 1e-6);
    }
  }
}

TEST(VoxelGrid, ThinsNoFurtherWhatItHasThinned) {
  const Cloud once = thin(scattered(20000, 10), 0.5).cloud;
  const Cloud twice = thin(once, 0.5).cloud;
  EXPECT_EQ(twice.x, once.x);
  EXPECT_EQ(twice.y, once.y);
  EXPECT_EQ(twice.z, once.z);
}

TEST(VoxelGrid, KeepsMillimetresFarFromTheOrigin) {
  // Float itself has 1/256 m at 40 km: the mean of four points must not lose more than that.
  const Cloud result = thin(cloud_of({{40000.25f, -39999.5f, 0},
                                      {40000.5f, -39999.25f, 0},
                                      {40000.25f, -39999.5f, 0},
                                      {40000.5f, -39999.25f, 0}}),
                            1)
                           .cloud;
  ASSERT_EQ(result.size(), 1u);
  EXPECT_NEAR(result.x[0], 40000.375, 1e-6);
  EXPECT_NEAR(result.y[0], -39999.375, 1e-6);
}

TEST(VoxelGrid, ServesCloudsAsWideAsItPromisesAndRefusesWiderOnes) {
  const Cloud wide = cloud_of({{-1048576, 0, 0}, {1048575, 0, 0}});  // 2^21 voxels of 1 m
  EXPECT_EQ(thin(wide, 1).cloud.size(), 2u);
  EXPECT_THAT(io::refusal([&] { thin(wide, 0.99); }),
              testing::AllOf(HasSubstr("more than 2^21 voxels"), HasSubstr("along x")));
}

TEST(VoxelGrid, AveragesNormalsToUnitLengthAndKeepsOneWhereTheyCancelOut) {
  Cloud cloud = cloud_of({{0.1f, 0, 0}, {0.2f, 0, 0}, {5.1f, 0, 0}, {5.2f, 0, 0}});
  cloud.nx = {1, 0, 0, 0};
  cloud.ny = {0, 1, 0, 0};
  cloud.nz = {0, 0, 1, -1};
  const Cloud result = thin(cloud, 1).cloud;
  ASSERT_TRUE(result.has_normals());
  EXPECT_LT((result.normal(0) - Eigen::Vector3f(M_SQRT1_2, M_SQRT1_2, 0)).norm(), 1e-6);
  EXPECT_EQ(result.normal(1), Eigen::Vector3f(0, 0, 1));
}

TEST(VoxelGrid, NamesTheFrameThatSawTheCellFromNearest) {
  const Cloud cloud = cloud_of({{10, 0, 0}, {10.1f, 0, 0}, {10.2f, 0, 0}, {-30, 0, 0}});
  const auto result =
      filter_voxel_grid::thin(cloud, {0, 2, 1, 0}, {{0, 0, 0}, {8, 0, 0}, {9, 0, 0}}, 1);
  EXPECT_THAT(result.frame, ElementsAre(2, 0));
}

TEST(VoxelGrid, DropsAndCountsPointsThatAreNoNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              inf = std::numeric_limits<float>::infinity();
  const auto result =
      filter_voxel_grid::thin(cloud_of({{nan, 0, 0}, {1, 2, 3}, {0, inf, 0}, {0, 0, -inf}}),
                              {0, 1, 0, 0}, {{0, 0, 0}, {0, 0, 0}}, 0.3);
  EXPECT_THAT(result.cloud.x, ElementsAre(1));
  EXPECT_THAT(result.frame, ElementsAre(1));
  EXPECT_EQ(result.dropped, 3u);
}

TEST(VoxelGrid, GivesAnEmptyCloudForAnEmptyOne) { EXPECT_TRUE(thin(Cloud(), 0.3).cloud.empty()); }

TEST(VoxelGrid, GivesASegmentWithItsOwnCentroidAndBox) {
  Segment segment;
  segment.range.end = 1;
  segment.range.T_segment_frame = {Pose()};
  segment = segment.with(scattered(1000, 4), std::vector<std::uint16_t>(1000, 0));
  const Step& step = *plumb_module()->steps[0];
  PortInput inputs[2];
  inputs[0].wired = true;
  inputs[0].one = any_value(segment);
  PortOutput output;
  TestContext context;
  step.run(step.parameters({{"voxel_size", 2.0}}).get(), inputs, {&output, 1}, context);
  const auto result = output.one.as<Segment>();
  EXPECT_EQ(result->cloud.size(), 8u);
  EXPECT_EQ(result->frame.size(), 8u);
  EXPECT_EQ(result->range.end, 1u);
  EXPECT_EQ(result->box.low, box_of(result->cloud).low);
}

}  // namespace
}  // namespace plumb::filter_voxel_grid
