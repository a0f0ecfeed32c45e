#include "similarity.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "plumb/data/error.hpp"
#include "plumb/plugin/context.hpp"

namespace plumb::loops_descriptor {
namespace {

constexpr Similarity every[] = {Similarity::inverse_difference, Similarity::cosine,
                                Similarity::chi_square};

/// A histogram of `bins` bins with sum 1, a third of them empty.
std::vector<float> histogram(std::size_t bins, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> h(bins);
  double sum = 0;
  for (auto& v : h) sum += v = static_cast<float>(std::max(0.0, random.uniform() - 1.0 / 3));
  for (auto& v : h) v = static_cast<float>(v / sum);
  return h;
}

TEST(Similarity, OfADescriptorWithItselfIsOne) {
  for (const auto measure : every)
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const auto a = histogram(640, seed);
      EXPECT_NEAR(similarity(a, a, measure, 1e-4), 1, 1e-12);
    }
}

TEST(Similarity, IsTheSameBothWaysAndBelowOne) {
  for (const auto measure : every) {
    const auto a = histogram(640, 1), b = histogram(640, 2);
    EXPECT_DOUBLE_EQ(similarity(a, b, measure, 1e-4), similarity(b, a, measure, 1e-4));
    EXPECT_LT(similarity(a, b, measure, 1e-4), 0.95);
    EXPECT_GT(similarity(a, b, measure, 1e-4), 0);
  }
}

TEST(Similarity, IsFiniteWhereSomeBinsAgree) {
  auto a = histogram(640, 1), b = histogram(640, 2);
  for (std::size_t k = 0; k < 640; k += 3) b[k] = a[k];
  const double s = similarity(a, b, Similarity::inverse_difference, 1e-4);
  EXPECT_TRUE(std::isfinite(s));
  EXPECT_LT(s, 1);
  EXPECT_GT(s,
            similarity(histogram(640, 1), histogram(640, 2), Similarity::inverse_difference, 1e-4));
}

TEST(Similarity, LeavesOutBinsThatAreEmptyInBoth) {
  // Weights 1 - k/K depend on the place, so the empty bins come last, in front of the weightless
  // end.
  std::vector<float> a = {0.5f, 0.5f, 0, 0}, b = {0.5f, 0.25f, 0, 0};
  const double w1 = 0.75, w2 = 0.5, agreement = 0.01 / 0.26;
  EXPECT_NEAR(similarity(a, b, Similarity::inverse_difference, 0.01),
              (w1 + w2 * agreement) / (w1 + w2), 1e-9);
}

TEST(Similarity, IsEquationOneTimesEpsilonWhereNoBinsAreNear) {
  const std::vector<float> a = {1, 5, 2, 7}, b = {4, 1, 8, 3};
  const double equation_one = (0.75 / 3 + 0.5 / 4 + 0.25 / 6 + 0) / 4;
  const double weights = 0.75 + 0.5 + 0.25;
  EXPECT_NEAR(similarity(a, b, Similarity::inverse_difference, 1e-9) / 1e-9,
              4 * equation_one / weights, 1e-8);
}

TEST(Similarity, AsPrintedIsEquationOneTimesAConstant) {
  const std::vector<float> a = {1, 5, 2, 7}, b = {4, 1, 8, 3};
  const double equation_one = (0.75 / 3 + 0.5 / 4 + 0.25 / 6 + 0) / 4;
  const double constant = 2 * 4 * 1e-3 / 3;
  EXPECT_NEAR(similarity(a, b, Similarity::equation_1, 1e-3), constant * equation_one, 1e-12);
}

TEST(Similarity, AsPrintedCountsEveryBinAndHasAFloorUnderItsDifferences) {
  // The first bin agrees to the floor, the second differs by 0.25, the last two are empty in both.
  const std::vector<float> a = {0.5f, 0.5f, 0, 0}, b = {0.505f, 0.25f, 0, 0};
  EXPECT_NEAR(similarity(a, b, Similarity::equation_1, 0.01),
              (0.75 + 0.5 * 0.01 / 0.25 + 0.25) / 1.5, 1e-6);
  EXPECT_DOUBLE_EQ(similarity(b, a, Similarity::equation_1, 0.01),
                   similarity(a, b, Similarity::equation_1, 0.01));
  EXPECT_DOUBLE_EQ(similarity(a, a, Similarity::equation_1, 0.01), 1);
}

TEST(Similarity, AsPrintedIsTheShareOfBinsThatAgreeWhereTheFloorIsLow) {
  const std::vector<float> a = {3, 5, 0, 7, 1}, b = {3, 1, 0, 2, 8};
  EXPECT_NEAR(similarity(a, b, Similarity::equation_1, 1e-9), (0.8 + 0.4) / 2, 1e-8);
}

TEST(Similarity, FallsAsDescriptorsPart) {
  const auto a = histogram(640, 1), b = histogram(640, 2);
  for (const auto measure : every) {
    double last = 2;
    for (const float mix : {0.0f, 0.2f, 0.5f, 1.0f}) {
      auto c = a;
      for (std::size_t k = 0; k < 640; ++k) c[k] = (1 - mix) * a[k] + mix * b[k];
      const double s = similarity(a, c, measure, 1e-4);
      EXPECT_LT(s, last);
      last = s;
    }
  }
}

TEST(Similarity, IsZeroWhereNothingCanBeCompared) {
  for (const auto measure : every) {
    EXPECT_EQ(similarity({0, 0}, {0, 0}, measure, 1e-4), 0);
    EXPECT_EQ(similarity({}, {}, measure, 1e-4), 0);
  }
}

TEST(Similarity, RefusesDescriptorsOfDifferentLengths) {
  EXPECT_THROW(similarity({1, 2}, {1, 2, 3}, Similarity::cosine, 1e-4), Error);
}

}  // namespace
}  // namespace plumb::loops_descriptor
