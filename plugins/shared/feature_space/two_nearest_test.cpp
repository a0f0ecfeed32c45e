#include "shared/feature_space/two_nearest.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shared/feature_space/feature_vectors_testing.hpp"

namespace plumb::feature_space {
namespace {

/// The definition: each with each, in double.
std::vector<TwoNearest> judge(const std::vector<float>& of, const std::vector<float>& among,
                              std::size_t dimension, const Apart& apart = {}) {
  const auto squared = [&](std::size_t i, std::size_t k) {
    double sum = 0;
    for (std::size_t d = 0; d < dimension; ++d) {
      const double x = static_cast<double>(of[i * dimension + d]) -
                       static_cast<double>(among[k * dimension + d]);
      sum += x * x;
    }
    return sum;
  };
  std::vector<TwoNearest> found(of.size() / dimension);
  for (std::size_t i = 0; i < found.size(); ++i) {
    TwoNearest& at = found[i];
    for (std::uint32_t k = 0; k < among.size() / dimension; ++k)
      if (const double d = squared(i, k); d < at.first_squared) at.first = k, at.first_squared = d;
    for (std::uint32_t k = 0; k < among.size() / dimension; ++k)
      if (const double d = squared(i, k);
          k != at.first && d < at.second_squared && (!apart || apart(at.first, k)))
        at.second = k, at.second_squared = d;
  }
  return found;
}

void expect_same(const std::vector<TwoNearest>& found, const std::vector<TwoNearest>& judged) {
  ASSERT_EQ(found.size(), judged.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].first, judged[i].first) << i;
    EXPECT_EQ(found[i].second, judged[i].second) << i;
    EXPECT_EQ(found[i].first_squared, judged[i].first_squared) << i;
    EXPECT_EQ(found[i].second_squared, judged[i].second_squared) << i;
  }
}

TEST(TwoNearest, AreThoseThatComparingWithEachFinds) {
  for (const std::size_t dimension : {1, 7, 33, 352})
    for (const auto& [n, m] : {std::pair<std::size_t, std::size_t>{1, 2}, {33, 40}, {100, 333}}) {
      const auto of = histograms(n, dimension, 1), among = histograms(m, dimension, 2);
      expect_same(two_nearest(of, among, dimension), judge(of, among, dimension));
    }
}

TEST(TwoNearest, AreExactWhereDistancesAreFarBelowTheRoundingOfProducts) {
  const auto of = histograms(150, 33, 3, 1e-4), among = histograms(200, 33, 4, 1e-4);
  expect_same(two_nearest(of, among, 33), judge(of, among, 33));
}

TEST(TwoNearest, OfEqualVectorsAreThoseWithTheLowestPlaces) {
  const auto once = histograms(20, 33, 5);
  auto thrice = once;
  for (int round = 0; round < 2; ++round) thrice.insert(thrice.end(), once.begin(), once.end());
  const auto found = two_nearest(once, thrice, 33);
  for (std::uint32_t k = 0; k < 20; ++k) {
    EXPECT_EQ(found[k].first, k);
    EXPECT_EQ(found[k].second, k + 20);
    EXPECT_EQ(found[k].second_squared, 0);
  }
}

TEST(TwoNearest, LeaveOutTheSecondOnesThatDoNotStandApart) {
  const auto of = histograms(60, 33, 6), among = histograms(90, 33, 7);
  const Apart apart = [](std::uint32_t first, std::uint32_t k) { return k / 10 != first / 10; };
  const auto found = two_nearest(of, among, 33, apart);
  expect_same(found, judge(of, among, 33, apart));
  for (const TwoNearest& at : found) EXPECT_NE(at.first / 10, at.second / 10);
}

TEST(TwoNearest, AreMissingWhereThereAreTooFewOthers) {
  const auto of = histograms(3, 33, 8);
  for (const TwoNearest& at : two_nearest(of, {}, 33)) EXPECT_EQ(at.first, none);
  for (const TwoNearest& at : two_nearest(of, histograms(1, 33, 9), 33)) {
    EXPECT_EQ(at.first, 0u);
    EXPECT_EQ(at.second, none);
  }
  EXPECT_TRUE(two_nearest({}, of, 33).empty());
}

TEST(TwoNearest, NeitherFindNorAreVectorsThatAreNoNumbers) {
  auto of = histograms(10, 33, 10), among = histograms(20, 33, 11);
  of[4 * 33 + 5] = std::numeric_limits<float>::quiet_NaN();
  among[7 * 33] = std::numeric_limits<float>::infinity();
  among[9 * 33] = 1e30f;  // its square fits no float
  const auto found = two_nearest(of, among, 33);
  EXPECT_EQ(found[4].first, none);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].first == none, i == 4);
    for (const std::uint32_t k : {found[i].first, found[i].second}) {
      EXPECT_NE(k, 7u);
      EXPECT_NE(k, 9u);
    }
  }
}

}  // namespace
}  // namespace plumb::feature_space
