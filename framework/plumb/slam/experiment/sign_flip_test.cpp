#include "plumb/slam/experiment/sign_flip.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plumb/data/random.hpp"

namespace plumb::experiment {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

/// By trying every choice of signs.
double p_by_brute_force(const std::vector<double>& d) {
  const double seen = std::abs(std::accumulate(d.begin(), d.end(), 0.0));
  std::size_t as_far = 0;
  for (std::size_t signs = 0; signs < (std::size_t{1} << d.size()); ++signs) {
    double sum = 0;
    for (std::size_t k = 0; k < d.size(); ++k) sum += (signs >> k & 1) ? -d[k] : d[k];
    as_far += std::abs(sum) >= seen - 1e-12;
  }
  return static_cast<double>(as_far) / std::ldexp(1.0, static_cast<int>(d.size()));
}

std::vector<double> drawn(std::size_t n, double centre, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k) values.push_back(centre + random.uniform() - 0.5);
  return values;
}

std::vector<double> shifted(std::vector<double> values, double by) {
  for (double& value : values) value += by;
  return values;
}

TEST(SignFlip, HasTheProbabilityOfAllChoicesOfSigns) {
  for (const std::size_t n : {1u, 2u, 5u, 6u, 9u, 12u})
    for (const double centre : {0.0, 0.1, -0.2, 0.6}) {
      const auto d = drawn(n, centre, 7 * n);
      EXPECT_NEAR(SignFlip(d).p(), p_by_brute_force(d), 1e-12) << n << " " << centre;
    }
  EXPECT_EQ(SignFlip({0, 0, 0, 0, 0, 0}).p(), 1);
  EXPECT_EQ(SignFlip({1, -1, 2, -2}).p(), 1);
}

TEST(SignFlip, HasAnIntervalOfWhatItDoesNotRefute) {
  for (const std::size_t n : {6u, 7u, 8u, 11u}) {
    const auto d = drawn(n, 0.2, n);
    const auto interval = SignFlip(d).interval();
    ASSERT_TRUE(interval);
    const auto p_of = [&](double value) { return p_by_brute_force(shifted(d, -value)); };
    EXPECT_LE(p_of(interval->low - 1e-9), 0.05);
    EXPECT_GT(p_of(interval->low + 1e-9), 0.05);
    EXPECT_GT(p_of(interval->high - 1e-9), 0.05);
    EXPECT_LE(p_of(interval->high + 1e-9), 0.05);
  }
}

TEST(SignFlip, OfSixIsTheirLeastAndTheirLargest) {
  const auto interval = SignFlip({0.3, 0.1, 0.2, 0.15, 0.25, 0.05}).interval();
  ASSERT_TRUE(interval);
  EXPECT_DOUBLE_EQ(interval->low, 0.05);
  EXPECT_DOUBLE_EQ(interval->high, 0.3);
  EXPECT_DOUBLE_EQ(SignFlip({0.3, 0.1, 0.2, 0.15, 0.25, 0.05}).p(), 2.0 / 64);
}

TEST(SignFlip, OfFewerThanSixProvesNothing) {
  const SignFlip five({1, 1, 1, 1, 1});
  EXPECT_FALSE(five.interval());
  EXPECT_DOUBLE_EQ(five.p(), 2.0 / 32);
  EXPECT_DOUBLE_EQ(five.least_p(), five.p());
}

TEST(SignFlip, HoldsNineteenOfTwenty) {
  int held = 0;
  constexpr int runs = 2000;
  for (int k = 0; k < runs; ++k) {
    const auto interval = SignFlip(drawn(8, 0.3, static_cast<std::uint64_t>(k) + 1)).interval();
    held += interval->low <= 0.3 && 0.3 <= interval->high;
  }
  // Exactly 1 - 2 * 6 / 256 = 0.953; three standard deviations.
  EXPECT_NEAR(static_cast<double>(held) / runs, 0.953, 0.015);
}

TEST(SignFlip, OfManyIsDrawnAndAlikeEachTime) {
  const auto d = drawn(30, 0.1, 3);
  const SignFlip test(d);
  EXPECT_EQ(test.p(), SignFlip(d).p());
  const auto interval = test.interval();
  ASSERT_TRUE(interval);
  // Student's t over the same differences, which are uniform.
  double squares = 0;
  for (const double one : d) squares += (one - test.mean()) * (one - test.mean());
  const double half = 2.045 * std::sqrt(squares / 29 / 30);
  EXPECT_NEAR(interval->low, test.mean() - half, 0.15 * half);
  EXPECT_NEAR(interval->high, test.mean() + half, 0.15 * half);
}

TEST(DifferencesNeeded, GrowWithTheNumberOfVariants) {
  EXPECT_EQ(differences_needed(0.05, 1), 6u);
  EXPECT_EQ(differences_needed(0.05, 2), 7u);
  EXPECT_EQ(differences_needed(0.05, 11), 9u);
  EXPECT_EQ(differences_needed(0.01, 1), 8u);
}

TEST(Holm, AdjustsTheSmallestMostAndKeepsTheOrder) {
  EXPECT_THAT(
      holm({0.01, 0.04, 0.03}),
      ElementsAre(DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12), DoubleNear(0.06, 1e-12)));
  EXPECT_THAT(holm({0.5, 0.6}), ElementsAre(DoubleNear(1, 1e-12), DoubleNear(1, 1e-12)));
  EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace plumb::experiment
