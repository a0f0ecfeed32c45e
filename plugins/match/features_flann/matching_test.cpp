#include "matching.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <thread>

#include "shared/feature_space/feature_vectors_testing.hpp"
#include "shared/feature_space/two_nearest.hpp"

namespace plumb::match_features_flann {
namespace {

using feature_space::histograms;

IndexOptions options(IndexKind kind, std::uint32_t checks = 128) {
  IndexOptions result;
  result.kind = kind;
  result.checks = checks;
  return result;
}
constexpr IndexKind approximate[] = {IndexKind::kmeans, IndexKind::hierarchical};
constexpr IndexKind all[] = {IndexKind::exact_tree, IndexKind::kmeans, IndexKind::hierarchical};

/// Mutual nearest neighbours by comparing each with each.
feature_space::Pairs judge(const std::vector<float>& a, const std::vector<float>& b,
                           std::size_t dimension) {
  const auto there = feature_space::two_nearest(a, b, dimension),
             back = feature_space::two_nearest(b, a, dimension);
  feature_space::Pairs pairs;
  for (std::uint32_t i = 0; i < there.size(); ++i)
    if (const auto j = there[i].first; j != feature_space::none && back[j].first == i)
      pairs.emplace_back(i, j);
  return pairs;
}

double recall(const Matching& found) {
  return static_cast<double>(found.exact) / static_cast<double>(found.sampled);
}

TEST(Matching, ByTheExactTreeIsThatOfAllPairs) {
  for (const std::size_t dimension : {1, 33, 352}) {
    const auto a = histograms(300, dimension, 1), b = histograms(350, dimension, 2);
    const Matching found = match(a, b, dimension, options(IndexKind::exact_tree), 300, 1);
    EXPECT_EQ(found.pairs, judge(a, b, dimension)) << dimension;
    EXPECT_EQ(found.sampled, 300u);
    EXPECT_EQ(found.exact, 300u);
  }
}

TEST(Matching, MissesSomeWithFewChecksAndNoneWithAsManyAsThereAreVectors) {
  const auto a = histograms(1500, 33, 3), b = histograms(2000, 33, 4);
  for (const IndexKind kind : approximate) {
    const Matching few = match(a, b, 33, options(kind, 1), 1500, 1),
                   many = match(a, b, 33, options(kind, 2000), 1500, 1);
    EXPECT_LT(recall(few), 0.99) << static_cast<int>(kind);
    EXPECT_GE(recall(many), 0.995) << static_cast<int>(kind);
    EXPECT_GT(recall(many), recall(few)) << static_cast<int>(kind);
    const auto right = judge(a, b, 33);
    feature_space::Pairs common;
    std::ranges::set_intersection(many.pairs, right, std::back_inserter(common));
    EXPECT_GE(common.size(), right.size() * 99 / 100) << static_cast<int>(kind);
  }
}

TEST(Matching, IsTheSameWhateverOtherThreadsDraw) {
  const auto a = histograms(800, 33, 5), b = histograms(900, 33, 6);
  for (const IndexKind kind : approximate) {
    const auto alone = match(a, b, 33, options(kind, 16), 0, 7).pairs;
    std::vector<feature_space::Pairs> together(4);
    {
      std::vector<std::jthread> threads;
      for (std::size_t t = 0; t < together.size(); ++t)
        threads.emplace_back([&, t] {
          std::srand(static_cast<unsigned>(t));
          match(b, a, 33, options(kind, 16), 0, t);  // leaves the thread's generator anywhere
          together[t] = match(a, b, 33, options(kind, 16), 0, 7).pairs;
        });
    }
    for (const auto& pairs : together) EXPECT_EQ(pairs, alone);
  }
}

TEST(Matching, DrawsNothingFromTheProcess) {
  const auto a = histograms(500, 33, 8), b = histograms(500, 33, 9);
  for (const IndexKind kind : all) {
    std::srand(5);
    const int expected = std::rand();
    std::srand(5);
    match(a, b, 33, options(kind), 100, 1);
    EXPECT_EQ(std::rand(), expected) << static_cast<int>(kind);
  }
}

TEST(Matching, EndsAmongEqualVectors) {
  std::vector<float> equal;
  for (int k = 0; k < 700; ++k) equal.insert(equal.end(), {1, 2, 3});
  for (const IndexKind kind : all) {
    const Matching found = match(equal, equal, 3, options(kind), 50, 1);
    EXPECT_GE(found.pairs.size(), 1u);
    EXPECT_EQ(found.exact, 50u);
  }
}

TEST(Matching, LeavesOutVectorsThatAreNoNumbers) {
  auto a = histograms(40, 33, 10), b = histograms(50, 33, 11);
  a[3 * 33 + 1] = std::numeric_limits<float>::quiet_NaN();
  b[8 * 33] = std::numeric_limits<float>::infinity();
  for (const IndexKind kind : all) {
    const Matching found = match(a, b, 33, options(kind), 40, 1);
    EXPECT_EQ(found.sampled, 39u);
    EXPECT_EQ(found.pairs, judge(a, b, 33)) << "all are looked at";
    for (const auto& [i, j] : found.pairs) {
      EXPECT_NE(i, 3u);
      EXPECT_NE(j, 8u);
    }
  }
}

TEST(Matching, OfNothingIsNothing) {
  const auto some = histograms(5, 33, 12);
  for (const IndexKind kind : all) {
    EXPECT_TRUE(match({}, some, 33, options(kind), 10, 1).pairs.empty());
    EXPECT_TRUE(match(some, {}, 33, options(kind), 10, 1).pairs.empty());
  }
}

}  // namespace
}  // namespace plumb::match_features_flann
