#include "plumb/slam/geometry/search_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace plumb {
namespace {

using Neighbour = SearchTree::Neighbour;

struct Points {
  std::vector<float> x, y, z;
  void add(float a, float b, float c) { x.push_back(a), y.push_back(b), z.push_back(c); }
};

/// Random points; on a coarse lattice when `step` > 0, so that equal distances and equal points
/// abound.
Points random_points(std::size_t n, unsigned seed, float step) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-10, 10);
  const auto next = [&] {
    const float c = coordinate(random);
    return step > 0 ? std::round(c / step) * step : c;
  };
  Points points;
  for (std::size_t k = 0; k < n; ++k) points.add(next(), next(), 0.2f * next());
  return points;
}

std::vector<Neighbour> by_brute_force(const Points& points, const Eigen::Vector3f& q) {
  std::vector<Neighbour> all;
  for (std::uint32_t k = 0; k < points.x.size(); ++k) {
    const float dx = points.x[k] - q.x(), dy = points.y[k] - q.y(), dz = points.z[k] - q.z();
    all.push_back({k, (dx * dx + dy * dy) + dz * dz});
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(SearchTree, AnswersAsBruteForceBitByBitAlsoAmongTies) {
  for (const float step : {0.0f, 1.0f, 4.0f})
    for (const std::size_t n : {1, 2, 7, 8, 9, 16, 17, 33, 100, 1000, 3001}) {
      const Points points = random_points(n, static_cast<unsigned>(n), step);
      const SearchTree tree(points);
      const Points queries = random_points(30, 99, step);
      for (std::size_t j = 0; j < queries.x.size(); ++j) {
        const float spread = j % 5 == 0 ? 4.0f : 1.0f;  // some far outside
        const Eigen::Vector3f q =
            spread * Eigen::Vector3f(queries.x[j], queries.y[j], queries.z[j]);
        const auto truth = by_brute_force(points, q);
        for (const std::size_t k : {1, 5, 20, 64}) {
          std::vector<Neighbour> found(k);
          found.resize(tree.nearest(q, k, found.data()));
          const auto expected = std::min(k, n);
          ASSERT_EQ(found, std::vector<Neighbour>(truth.begin(), truth.begin() + expected));
        }
        for (const float radius : {0.0f, 1.0f, 2.0f, 5.5f, 100.0f}) {
          std::vector<Neighbour> expected;
          for (const auto& each : truth)
            if (each.squared_distance <= radius * radius) expected.push_back(each);
          std::vector<Neighbour> found{{7, 7.0f}};
          tree.within(q, radius, found, true);
          ASSERT_EQ(found, expected);
          tree.within(q, radius, found, false);
          std::sort(found.begin(), found.end());
          ASSERT_EQ(found, expected);
          Neighbour one{123, -1};
          ASSERT_EQ(tree.nearest_within(q, radius, one), !expected.empty());
          ASSERT_EQ(one, expected.empty() ? (Neighbour{123, -1}) : expected.front());
        }
      }
    }
}

TEST(SearchTree, ListsManyEqualPointsByIndex) {
  Points points;
  for (int k = 0; k < 500; ++k) points.add(1, 2, 3);
  const SearchTree tree(points);
  Neighbour found[40];
  ASSERT_EQ(tree.nearest({0, 0, 0}, 40, found), 40u);
  for (std::uint32_t k = 0; k < 40; ++k) EXPECT_EQ(found[k], (Neighbour{k, 14.0f}));
}

TEST(SearchTree, OfNothingFindsNothing) {
  const SearchTree tree(Points{});
  Neighbour one;
  std::vector<Neighbour> many(3);
  EXPECT_EQ(tree.nearest({0, 0, 0}, 1, &one), 0u);
  EXPECT_FALSE(tree.nearest_within({0, 0, 0}, 1e9f, one));
  tree.within({0, 0, 0}, 1e9f, many, true);
  EXPECT_TRUE(many.empty());
}

TEST(SearchTree, NeverFindsPointsThatAreNowhere) {
  Points points;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 40; ++k) {
    points.add(nan, 0, 0);
    points.add(0, infinite, 0);
  }
  points.add(5, 0, 0);
  const SearchTree tree(points);
  EXPECT_EQ(tree.size(), 1u);
  Neighbour found[3];
  ASSERT_EQ(tree.nearest({0, 0, 0}, 3, found), 1u);
  EXPECT_EQ(found[0], (Neighbour{80, 25.0f}));
  EXPECT_EQ(tree.nearest({nan, 0, 0}, 3, found), 0u);
}

}  // namespace
}  // namespace plumb
