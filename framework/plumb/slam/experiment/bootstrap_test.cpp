#include "plumb/slam/experiment/bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plumb/data/random.hpp"

namespace plumb::experiment {
namespace {

using Pairs = std::vector<std::vector<RunPair>>;

SegmentSums sums_of(std::vector<double> values, bool root = false) {
  const std::size_t n = values.size();
  return {root, std::move(values), std::vector<double>(n, 1)};
}

TEST(SegmentSums, AreTheMeanOrItsRoot) {
  const SegmentSums sums{false, {1, 4, 7}, {1, 2, 1}};
  EXPECT_DOUBLE_EQ(sums.value(), 3);
  EXPECT_DOUBLE_EQ(sums.value({2, 0, 1}), 3);
  EXPECT_DOUBLE_EQ(sums.value({0, 1, 0}), 2);
  EXPECT_TRUE(std::isnan(sums.value({0, 0, 0})));
  EXPECT_DOUBLE_EQ(SegmentSums({true, {1, 49}, {1, 1}}).value(), 5);
}

TEST(Bootstrap, OfTwoSegmentsHasThePercentilesOfAllDraws) {
  // Both segments, or one twice: ratios 2 (a quarter of the draws), 3 and 4 (a quarter).
  const SegmentSums a = sums_of({1, 1}), b = sums_of({2, 4});
  const auto made = bootstrap({{{1, 3, &a, &b}}}, Scale::ratio, 2000, 1);
  ASSERT_EQ(made.resampled, Resampled::segments);
  EXPECT_NEAR(made.interval.low, std::log(2), 1e-12);
  EXPECT_NEAR(made.interval.high, std::log(4), 1e-12);
  const auto ninety = bootstrap({{{1, 3, &a, &b}}}, Scale::ratio, 2000, 1, 0.6);
  EXPECT_NEAR(ninety.interval.low, std::log(3), 1e-12);  // the 30 % quantile
}

TEST(Bootstrap, TakesTheSameSegmentsOfBothVariants) {
  // Segments are of very unequal difficulty, the ratio is 0.9 in all of them.
  const SegmentSums a = sums_of({1, 10, 100, 1000}), b = sums_of({0.9, 9, 90, 900});
  const auto made = bootstrap({{{277.75, 249.975, &a, &b}}}, Scale::ratio, 500, 3);
  EXPECT_NEAR(made.interval.low, std::log(0.9), 1e-12);
  EXPECT_NEAR(made.interval.high, std::log(0.9), 1e-12);
}

TEST(Bootstrap, FindsThemByTheirPlaceWhereSegmentsAreCutOtherwise) {
  const SegmentSums a = sums_of({1, 10}), b = sums_of({0.5, 0.5, 5, 5});
  const auto made = bootstrap({{{5.5, 2.75, &a, &b}}}, Scale::ratio, 500, 3);
  EXPECT_NEAR(made.interval.low, std::log(0.5), 1e-12);
  EXPECT_NEAR(made.interval.high, std::log(0.5), 1e-12);
}

TEST(Bootstrap, HasTheSpreadOfAMean) {
  Random random(5);
  SegmentSums a, b;
  double mean = 0, squares = 0;
  constexpr int n = 50;
  for (int k = 0; k < n; ++k) {
    const double difference = random.uniform();
    a.sum.push_back(1), b.sum.push_back(1 + difference);
    a.count.push_back(1), b.count.push_back(1);
    mean += difference / n, squares += difference * difference / n;
  }
  const double deviation = std::sqrt((squares - mean * mean) / n);
  const auto made = bootstrap({{{1, 1 + mean, &a, &b}}}, Scale::difference, 4000, 2);
  EXPECT_NEAR(made.interval.low, mean - 1.96 * deviation, 0.15 * deviation);
  EXPECT_NEAR(made.interval.high, mean + 1.96 * deviation, 0.15 * deviation);
}

TEST(Bootstrap, DrawsReplicatesWhereSegmentsAreNotKnown) {
  const SegmentSums known = sums_of({1, 1});
  const Pairs three{{{1, 2}, {1, 4}, {1, 3, &known, nullptr}}};
  const auto made = bootstrap(three, Scale::ratio, 2000, 1);
  EXPECT_EQ(made.resampled, Resampled::replicates);
  EXPECT_NEAR(made.interval.low, std::log(2), 1e-12);  // 1 of 27 draws
  EXPECT_NEAR(made.interval.high, std::log(4), 1e-12);
  EXPECT_EQ(bootstrap({{{1, 2}, {1, 4}}}, Scale::ratio, 2000, 1).resampled, Resampled::nothing);
  EXPECT_EQ(bootstrap({}, Scale::ratio, 2000, 1).resampled, Resampled::nothing);
}

TEST(Bootstrap, OfTheSameRunsIsNothingAtAll) {
  const SegmentSums a = sums_of({1, 2, 3}, true);
  const auto made = bootstrap({{{1, 1, &a, &a}}, {{2, 2, &a, &a}}}, Scale::ratio, 100, 1);
  EXPECT_EQ(made.interval.low, 0);
  EXPECT_EQ(made.interval.high, 0);
}

}  // namespace
}  // namespace plumb::experiment
