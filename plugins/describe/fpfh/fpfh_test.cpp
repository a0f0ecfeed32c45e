#include "fpfh.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "border.hpp"
#include "pair_counts.hpp"
#include "plumb/plugin/testing.hpp"
#include "plumb/slam/geometry/pose.hpp"
#include "plumb/slam/step.hpp"
#include "scene_for_test.hpp"
#include "shared/keypoints/one_per_voxel.hpp"
#include "shared/parallel/loop_testing.hpp"

#ifdef PLUMB_HAS_PCL
#include "pcl_twins.hpp"
#endif

namespace plumb::describe_fpfh {
namespace {

using keypoints::one_per_voxel;

Oriented point_of(const Support& s, std::uint32_t k) {
  return {s.x[k], s.y[k], s.z[k], s.nx[k], s.ny[k], s.nz[k]};
}

float squared_distance(const Cloud& cloud, std::size_t a, std::size_t b) {
  return (cloud.point(a) - cloud.point(b)).squaredNorm();
}

FpfhOptions within(double radius, std::optional<std::uint32_t> most = {}) {
  FpfhOptions options;
  options.radius = radius;
  options.max_neighbours = most;
  return options;
}

/// The share of numbers that agree within `tolerance`.
double share_within(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t close = 0;
  for (std::size_t k = 0; k < a.size(); ++k) close += std::abs(a[k] - b[k]) <= tolerance;
  return static_cast<double>(close) / static_cast<double>(a.size());
}

TEST(Support, OffersEveryPointWithinTheRadius) {
  const Cloud cloud = street_corner(2000, 1);
  const float radius = 1.3f;
  const Support support(cloud, radius);
  ASSERT_EQ(support.size(), cloud.size());
  CandidateFinder finder(support);
  for (const auto& cell : support.cells()) {
    const Candidates& candidates = finder.around(cell);
    for (auto place = cell.first; place < cell.end; ++place) {
      std::size_t offered = 0, there = 0;
      for (std::size_t k = 0; k < candidates.size; ++k)
        offered += std::isfinite(candidates.x[k]) &&
                   squared_distance(cloud, support.index[candidates.place[k]],
                                    support.index[place]) <= radius * radius;
      for (std::size_t k = 0; k < cloud.size(); ++k)
        there += squared_distance(cloud, k, support.index[place]) <= radius * radius;
      ASSERT_EQ(offered, there);
    }
  }
}

TEST(PairCounts, AreWhatOneReads) {
  const Cloud cloud = street_corner(6000, 2);
  const Support support(cloud, 2);
  CandidateFinder finder(support);
  std::uint64_t sum = 0, off = 0;
  for (const auto& cell : support.cells()) {
    const Candidates& candidates = finder.around(cell);
    const Oriented point = point_of(support, cell.first);
    const PairCounts fast = count_pairs(point, candidates, 4),
                     plain = count_pairs_plainly(point, candidates, 4);
    EXPECT_EQ(fast.neighbours, plain.neighbours);
    for (std::size_t b = 0; b < 33; ++b) {
      sum += plain.bins[b];
      off += static_cast<std::uint64_t>(std::abs(int(plain.bins[b]) - int(fast.bins[b])));
    }
  }
  EXPECT_LT(off,
            1e-5 * static_cast<double>(sum) + 3);  // angles on the edge of a bin, rounded otherwise
}

TEST(PairCounts, OfAPlaneFallIntoTheMiddleBins) {
  Cloud cloud;
  for (int i = 0; i < 400; ++i)
    cloud.add({0.1f * static_cast<float>(i % 20), 0.1f * static_cast<float>(i / 20), 3});
  cloud.nx.assign(400, 0), cloud.ny.assign(400, 0), cloud.nz.assign(400, 1);
  const Support support(cloud, 0.35);
  CandidateFinder finder(support);
  for (const auto& cell : support.cells()) {
    const PairCounts counts =
        count_pairs(point_of(support, cell.first), finder.around(cell), 0.1225f);
    for (const std::size_t b : {5u, 16u, 27u}) EXPECT_EQ(counts.bins[b], counts.neighbours - 1);
  }
}

TEST(PairCounts, CountMoreNeighboursThanAByteHolds) {
  Cloud cloud;
  Random random(7);
  for (int i = 0; i < 9000; ++i)
    cloud.add(Eigen::Vector3f::NullaryExpr([&] { return static_cast<float>(random.uniform()); }));
  cloud.nx.assign(9000, 0), cloud.ny.assign(9000, 0), cloud.nz.assign(9000, 1);
  const Support support(cloud, 2);
  CandidateFinder finder(support);
  const auto counts = count_pairs(point_of(support, 0), finder.around(support.cells()[0]), 4);
  EXPECT_EQ(counts.neighbours, 9000u);
  EXPECT_EQ(counts.bins[5], 8999u);
}

TEST(KeyPoints, AreOneRealPointPerCellNearestToItsMean) {
  const Cloud cloud = street_corner(5000, 3);
  const auto keys = one_per_voxel(cloud, 0.9);
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells;
  const auto cell_of = [&](std::size_t k) {
    const Eigen::Vector3d at = (cloud.point(k).cast<double>() / 0.9).array().floor();
    return std::array<int, 3>{static_cast<int>(at.x()), static_cast<int>(at.y()),
                              static_cast<int>(at.z())};
  };
  for (std::size_t k = 0; k < cloud.size(); ++k) cells[cell_of(k)].push_back(k);
  EXPECT_EQ(keys.size(), cells.size());
  EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  for (const auto key : keys) {
    const auto& members = cells[cell_of(key)];
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto k : members)
      mean += cloud.point(k).cast<double>() / static_cast<double>(members.size());
    for (const auto k : members)
      EXPECT_LE((cloud.point(key).cast<double>() - mean).norm(),
                (cloud.point(k).cast<double>() - mean).norm() + 1e-6);
  }
}

TEST(KeyPoints, HaveANormal) {
  Cloud cloud = street_corner(500, 3);
  for (std::size_t k = 0; k < cloud.size(); k += 2) cloud.nx[k] = cloud.ny[k] = cloud.nz[k] = 0;
  for (const auto key : one_per_voxel(cloud, 0.5)) EXPECT_EQ(key % 2, 1u);
}

TEST(LargestGap, IsHalfATurnOnTheEdgeOfAPatchAndSmallInside) {
  Cloud cloud;
  Random random(5);
  for (int k = 0; k < 3000; ++k)
    cloud.add(
        {static_cast<float>(10 * random.uniform()), static_cast<float>(10 * random.uniform()), 0});
  cloud.add({0, 5, 0}), cloud.add({5, 5, 0}), cloud.add({0, 0, 0});
  cloud.nx.assign(cloud.size(), 0), cloud.ny.assign(cloud.size(), 0),
      cloud.nz.assign(cloud.size(), 1);
  const Support support(cloud, 1.5);
  CandidateFinder finder(support);
  for (const auto& cell : support.cells()) {
    const Candidates& candidates = finder.around(cell);
    for (auto place = cell.first; place < cell.end; ++place) {
      // The second way: all angles, sorted.
      std::vector<double> angles;
      const auto k = support.index[place];
      for (std::size_t m = 0; m < cloud.size(); ++m)
        if (m != k && squared_distance(cloud, m, k) <= 2.25f)
          angles.push_back(std::atan2(cloud.y[m] - cloud.y[k], cloud.x[m] - cloud.x[k]));
      std::sort(angles.begin(), angles.end());
      double expected = angles.front() + 2 * std::numbers::pi - angles.back();
      for (std::size_t m = 1; m < angles.size(); ++m)
        expected = std::max(expected, angles[m] - angles[m - 1]);
      const double gap = largest_gap(point_of(support, place), candidates, 2.25f);
      if (expected >= std::numbers::pi / 4)
        EXPECT_NEAR(gap, expected, 1e-4) << k;
      else
        EXPECT_LT(gap, std::numbers::pi / 4) << k;
      switch (k) {
        case 3000:
          EXPECT_NEAR(gap, std::numbers::pi, 0.2);
          break;
        case 3001:
          EXPECT_LT(gap, 0.8);
          break;
        case 3002:
          EXPECT_NEAR(gap, 1.5 * std::numbers::pi, 0.3);
          break;
        default:
          break;
      }
    }
  }
}

TEST(Fpfh, HasThreePartsThatSumToOneHundred) {
  const Cloud cloud = street_corner(4000, 4);
  TestContext context;
  const auto result = fpfh(cloud, one_per_voxel(cloud, 0.8), within(1.5), context);
  const Features& f = result.features;
  ASSERT_GT(f.size(), 300u);
  EXPECT_EQ(f.normals.size(), f.size());
  EXPECT_EQ(f.at_border.size(), f.size());
  EXPECT_EQ(f.vectors.size(), 33 * f.size());
  for (std::size_t k = 0; k < f.size(); ++k)
    for (int part = 0; part < 3; ++part)
      EXPECT_NEAR(std::accumulate(f.vector(k) + 11 * part, f.vector(k) + 11 * part + 11, 0.0), 100,
                  1e-3);
}

TEST(Fpfh, DoesNotChangeWhenTheCloudIsMoved) {
  const Cloud here = street_corner(4000, 5);
  Cloud there = here;
  const Motion motion(Pose(exp_rotation({0.4, -0.7, 1.9}), {12, -30, 4}));
  for (std::size_t k = 0; k < here.size(); ++k) {
    const Eigen::Vector3f p = motion * here.point(k), n = motion.r * here.normal(k);
    there.x[k] = p.x(), there.y[k] = p.y(), there.z[k] = p.z();
    there.nx[k] = n.x(), there.ny[k] = n.y(), there.nz[k] = n.z();
  }
  const auto keys = one_per_voxel(here, 0.8);
  TestContext context;
  const auto a = fpfh(here, keys, within(1.5), context),
             b = fpfh(there, keys, within(1.5), context);
  EXPECT_GT(share_within(a.features.vectors, b.features.vectors, 0.1f), 0.97);
}

TEST(Fpfh, IsTheSameForOneAndForFourThreads) {
  const Cloud cloud = street_corner(20000, 6);
  const auto keys = one_per_voxel(cloud, 0.5);
  TestContext alone;
  parallel::ThreadedContext together;
  const auto one = fpfh(cloud, keys, within(1), alone),
             four = fpfh(cloud, keys, within(1), together);
  EXPECT_EQ(one.features.vectors, four.features.vectors);
  EXPECT_EQ(one.features.at_border, four.features.at_border);
}

TEST(Fpfh, TakesOnlyTheNearestNeighboursWhenTold) {
  const Cloud cloud = street_corner(3000, 7);
  const auto keys = one_per_voxel(cloud, 0.8);
  TestContext context;
  const auto all = fpfh(cloud, keys, within(1), context);
  const auto as_many = fpfh(cloud, keys, within(1, 3000), context);
  const auto few = fpfh(cloud, keys, within(1, 15), context);
  EXPECT_EQ(all.features.vectors, as_many.features.vectors);
  EXPECT_LT(share_within(all.features.vectors, few.features.vectors, 0.1f), 0.7);
}

TEST(Fpfh, LeavesOutPointsWithFewNeighboursOrWithoutNormal) {
  Cloud cloud = street_corner(3000, 8);
  const auto in = cloud.size();
  cloud.add({100, 100, 100});
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(1);
  cloud.add({5, 5, 0.5f});
  cloud.nx.push_back(0), cloud.ny.push_back(0), cloud.nz.push_back(0);
  TestContext context;
  const auto result =
      fpfh(cloud, {0, static_cast<std::uint32_t>(in), static_cast<std::uint32_t>(in + 1)},
           within(1.5), context);
  EXPECT_EQ(result.index, std::vector<std::uint32_t>{0});
  EXPECT_EQ(result.left_out, 2u);
}

TEST(Fpfh, OfAnEmptyCloudIsEmpty) {
  TestContext context;
  const auto result = fpfh(Cloud{}, one_per_voxel(Cloud{}, 1), {}, context);
  EXPECT_EQ(result.features.size(), 0u);
  EXPECT_EQ(result.features.dimension, 33u);
}

#ifdef PLUMB_HAS_PCL
/// Mutual nearest neighbours by comparing all pairs.
std::vector<std::pair<std::size_t, std::size_t>> mutual(const std::vector<float>& a,
                                                        const std::vector<float>& b) {
  const std::size_t n = a.size() / 33, m = b.size() / 33;
  std::vector<std::size_t> of_a(n), of_b(m);
  std::vector<double> best_a(n, 1e300), best_b(m, 1e300);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      double d = 0;
      for (std::size_t c = 0; c < 33; ++c) d += std::pow(double{a[i * 33 + c]} - b[j * 33 + c], 2);
      if (d < best_a[i]) best_a[i] = d, of_a[i] = j;
      if (d < best_b[j]) best_b[j] = d, of_b[j] = i;
    }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < n; ++i)
    if (of_b[of_a[i]] == i) pairs.emplace_back(i, of_a[i]);
  return pairs;
}

std::vector<float> fpfh_of_pcl(const Cloud& cloud, const std::vector<std::uint32_t>& keys,
                               double radius) {
  return twins::PclCloud(cloud.x, cloud.y, cloud.z, cloud.nx, cloud.ny, cloud.nz)
      .fpfh(keys, radius, 2);
}

TEST(Fpfh, AgreesWithPcl) {
  const Cloud a = street_corner(8000, 9), b = street_corner(8000, 10);
  const FpfhOptions options = within(1.2);
  TestContext context;
  const auto ours_a = fpfh(a, one_per_voxel(a, 0.7), options, context),
             ours_b = fpfh(b, one_per_voxel(b, 0.7), options, context);
  const auto pcl_a = fpfh_of_pcl(a, ours_a.index, 1.2), pcl_b = fpfh_of_pcl(b, ours_b.index, 1.2);
  EXPECT_GE(share_within(ours_a.features.vectors, pcl_a, 0.1f), 0.95);  // full scale is 100
  EXPECT_GE(share_within(ours_b.features.vectors, pcl_b, 0.1f), 0.95);

  const auto ours = mutual(ours_a.features.vectors, ours_b.features.vectors),
             theirs = mutual(pcl_a, pcl_b);
  std::vector<std::pair<std::size_t, std::size_t>> common;
  std::set_intersection(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                        std::back_inserter(common));
  EXPECT_GE(static_cast<double>(common.size()),
            0.95 * static_cast<double>(std::max(ours.size(), theirs.size())));
  RecordProperty("mutual", static_cast<int>(common.size()));
}
#endif

}  // namespace
}  // namespace plumb::describe_fpfh
