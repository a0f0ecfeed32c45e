#include "esf.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numeric>
#include <thread>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/geometry/pose.hpp"
#include "solid_grid.hpp"
#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::describe_esf {
namespace {

/// Ground, a wall and a ball.
Cloud scene(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 4 < 2) cloud.add({uniform(0, 20), uniform(0, 10), uniform(-0.02, 0.02)});
    if (k % 4 == 2) cloud.add({uniform(0, 20), uniform(9.98, 10.02), uniform(0, 6)});
    if (k % 4 == 3) {
      const float z = uniform(-1, 1), turn = uniform(0, 6.2831853), r = std::sqrt(1 - z * z);
      cloud.add({5 + 2 * r * std::cos(turn), 4 + 2 * r * std::sin(turn), 2 + 2 * z});
    }
  }
  return cloud;
}

double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(a[k] - b[k]);
  return sum;
}

TEST(SolidGrid, IsSolidRoundEachPointAndNowhereElse) {
  const SolidGrid grid({{0.5f, 0.5f, 0.5f}, {-32, 10, 32}});
  int solid = 0;
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 64; ++y)
      for (int z = 0; z < 64; ++z) solid += grid.solid({x, y, z});
  EXPECT_EQ(solid, 27 + 2 * 3 * 2);  // the second one lies on an edge of the grid
  EXPECT_TRUE(grid.solid({32, 32, 32}));
  EXPECT_TRUE(grid.solid({31, 33, 31}));
  EXPECT_FALSE(grid.solid({30, 32, 32}));
  EXPECT_TRUE(grid.solid({0, 41, 63}));
}

TEST(SolidGrid, TracesStraightLines) {
  std::vector<Eigen::Vector3f> row;
  for (int k = -20; k < 20; ++k) row.push_back({static_cast<float>(k) + 0.5f, 0.5f, 0.5f});
  const SolidGrid grid(row);
  const Line along = grid.trace({12, 32, 32}, {51, 32, 32}),
             back = grid.trace({51, 32, 32}, {12, 32, 32});
  EXPECT_EQ(along.cells, 39);
  EXPECT_EQ(along.solid, 39);
  EXPECT_EQ(back.solid, 39);
  const Line across = grid.trace({32, 10, 32}, {32, 50, 32});
  EXPECT_EQ(across.cells, 40);
  EXPECT_EQ(across.solid, 3);
  const Line slanting = grid.trace({32, 12, 12}, {32, 52, 52});
  EXPECT_EQ(slanting.cells, 40);
  EXPECT_EQ(slanting.solid, 3);
  EXPECT_EQ(grid.trace({0, 0, 0}, {0, 0, 0}).cells, 1);
}

TEST(Esf, SumsToOneAndHasNoNegativeNumber) {
  const auto values = esf(scene(3000, 1), 5000, 1).value();
  ASSERT_EQ(values.size(), 640u);
  EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 1, 1e-5);
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0);
}

TEST(Esf, IsTheSameForTheSameSeedAndNearlySoForAnother) {
  const Cloud cloud = scene(3000, 2);
  const auto one = esf(cloud, 20000, 7).value();
  EXPECT_EQ(one, esf(cloud, 20000, 7).value());
  const auto other = esf(cloud, 20000, 8).value();
  EXPECT_NE(one, other);
  EXPECT_LT(difference(one, other), 0.12);
}

TEST(Esf, DoesNotSeeScaleAndHardlyTheTurnOfACloud) {
  const Cloud cloud = scene(3000, 3);
  Cloud larger = cloud, turned = cloud;
  const Motion motion(Pose(exp_rotation({0, 0, 1.1}), {100, 50, -3}));
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    larger.x[k] *= 4, larger.y[k] *= 4, larger.z[k] *= 4;
    const Eigen::Vector3f p = motion * cloud.point(k);
    turned.x[k] = p.x(), turned.y[k] = p.y(), turned.z[k] = p.z();
  }
  const auto values = esf(cloud, 20000, 1).value();
  EXPECT_EQ(values, esf(larger, 20000, 1).value());
  EXPECT_LT(difference(values, esf(turned, 20000, 1).value()), 0.25);
}

TEST(Esf, TellsShapesApart) {
  Cloud ball, plane;
  Random random(4);
  for (int k = 0; k < 3000; ++k) {
    const auto z = static_cast<float>(2 * random.uniform() - 1),
               turn = static_cast<float>(6.2831853 * random.uniform());
    const float r = std::sqrt(1 - z * z);
    ball.add({r * std::cos(turn), r * std::sin(turn), z});
    plane.add({z, turn, 0});
  }
  EXPECT_GT(difference(esf(ball, 5000, 1).value(), esf(plane, 5000, 1).value()), 1.0);
}

TEST(Esf, IsNothingWithoutATriangle) {
  Cloud line;
  EXPECT_FALSE(esf(line, 100, 1));
  line.add({0, 0, 0});
  line.add({1, 0, 0});
  EXPECT_FALSE(esf(line, 100, 1));
  for (int k = 2; k < 50; ++k) line.add({static_cast<float>(k), 0, 0});
  EXPECT_FALSE(esf(line, 100, 1));
  Cloud same;
  for (int k = 0; k < 50; ++k) same.add({3, 3, 3});
  EXPECT_FALSE(esf(same, 100, 1));
}

TEST(Esf, LeavesOutPointsThatAreNoNumbers) {
  Cloud cloud = scene(1000, 5);
  const auto values = esf(cloud, 1000, 1).value();
  cloud.add({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  EXPECT_EQ(values, esf(cloud, 1000, 1).value());
}

#ifdef PLUMB_HAS_PCL
TEST(Esf, HasTheMeanOfPclWithinTheNoiseOfSampling) {
  const Cloud cloud = scene(3000, 6);
  const twins::PclCloud twin(cloud.x, cloud.y, cloud.z, {}, {}, {});
  std::vector<std::vector<float>> pcl;
  for (int run = 0; run < 3; ++run) {
    if (run > 0)
      std::this_thread::sleep_for(
          std::chrono::milliseconds(1010));  // PCL's seed is the time in seconds
    pcl.push_back(twin.esf());
  }
  ASSERT_NE(pcl[0], pcl[1]);
  std::vector<double> ours_mean(640), ours_spread(640), pcl_mean(640);
  constexpr int runs = 25;
  for (int run = 0; run < runs; ++run) {
    const auto values = esf(cloud, 20000, 100 + static_cast<std::uint64_t>(run)).value();
    for (std::size_t k = 0; k < 640; ++k) {
      ours_mean[k] += values[k] / runs;
      ours_spread[k] += double{values[k]} * values[k] / runs;
    }
  }
  double chi_squared = 0;
  int counted = 0;
  for (std::size_t k = 0; k < 640; ++k) {
    for (const auto& values : pcl) pcl_mean[k] += values[k] / 3;
    const double variance = std::max(ours_spread[k] - ours_mean[k] * ours_mean[k], 1e-10);
    const double off = pcl_mean[k] - ours_mean[k];
    if (ours_mean[k] < 2e-5) {
      EXPECT_LT(pcl_mean[k], 2e-4) << "bin " << k;
      continue;
    }
    EXPECT_LT(std::abs(off), 6 * std::sqrt(variance * (1.0 / 3 + 1.0 / runs)) + 2e-5)
        << "bin " << k;
    chi_squared += off * off / (variance * (1.0 / 3 + 1.0 / runs));
    ++counted;
  }
  EXPECT_GT(counted, 250);
  EXPECT_LT(chi_squared / counted, 1.6);  // 1 where both draw from the same distribution
}
#endif

}  // namespace
}  // namespace plumb::describe_esf
