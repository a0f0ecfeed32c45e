#include "plumb/slam/experiment/verdict.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "plumb/slam/experiment/measured_testing.hpp"

namespace plumb::experiment {
namespace {

using test::measured, test::normal;
using testing::ElementsAre;

Rules rules() {
  Rules made;
  made.primary = "error.fine.ate";
  return made;
}

/// The one contrast of two variants in the one number.
Contrast only(const Measured& of, const Rules& by = rules()) {
  const auto all = judge(of, by);
  EXPECT_EQ(all.size(), 1u);
  EXPECT_EQ(all.front().contrasts.size(), 1u);
  return all.front().contrasts.front();
}

/// Six inputs of very unlike difficulty; B is A times `factor`, give or take `noise`.
Measured six(double factor, double noise, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> a, b;
  for (int k = 0; k < 6; ++k) {
    a.push_back(0.05 * std::pow(3, k));
    b.push_back(a.back() * factor * std::exp(noise * normal(random)));
  }
  return measured({"a", "b"}, 6, [&](std::size_t v, std::size_t k, std::size_t) {
    return std::optional(v == 0 ? a[k] : b[k]);
  });
}

TEST(Verdict, OfAAgainstAWithOtherNoiseIsEquivalentAndHardlyEverElse) {
  int equivalent = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Verdict verdict = only(six(1, 0.015, seed)).verdict;
    equivalent += verdict == Verdict::equivalent;
    wrong += verdict == Verdict::better || verdict == Verdict::worse;
  }
  EXPECT_GE(equivalent, 150);
  EXPECT_LE(wrong, 10);
  // Where the noise is too large for "equivalent", a false verdict is as rare as promised.
  wrong = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Verdict verdict = only(six(1, 0.2, seed)).verdict;
    wrong += verdict == Verdict::better || verdict == Verdict::worse;
  }
  EXPECT_LE(wrong, 20);
}

TEST(Verdict, OfAnErrorThatIsTenPercentHigherIsWorse) {
  int worse = 0, better = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    worse += only(six(1.1, 0.015, seed)).verdict == Verdict::worse;
    better += only(six(1 / 1.1, 0.015, seed)).verdict == Verdict::better;
  }
  EXPECT_GE(worse, 180);
  EXPECT_GE(better, 180);
}

TEST(Verdict, IsOfRatiosSoThatTheLargestErrorDoesNotDecide) {
  // 20 % less on five inputs, a little more on the one whose error is largest by far.
  const auto of = measured({"a", "b"}, 6, [](std::size_t v, std::size_t k, std::size_t) {
    const double a = k == 5 ? 10 : 0.1;
    return std::optional(v == 0 ? a : k == 5 ? 1.01 * a : 0.8 * a);
  });
  const Contrast c = only(of);
  EXPECT_NEAR(std::exp(c.estimate), std::pow(0.8, 5.0 / 6) * std::pow(1.01, 1.0 / 6), 1e-12);
  EXPECT_EQ(c.verdict, Verdict::large);
}

TEST(Verdict, OfFewInputsIsOfTheseDataAlone) {
  Measured of = measured({"a", "b"}, 2, [](std::size_t v, std::size_t k, std::size_t) {
    return std::optional((v == 0 ? 1.0 : 1.5) * static_cast<double>(k + 1));
  });
  Contrast c = only(of);
  EXPECT_EQ(c.method, Method::none);
  EXPECT_EQ(c.verdict, Verdict::large);
  EXPECT_DOUBLE_EQ(c.least_p, 0.5);
  for (std::size_t v = 0; v < 2; ++v)
    for (std::size_t k = 0; k < 2; ++k) {
      Figure& figure = of.at(v, k).figures.front();
      const double each = figure.number.value;
      figure.segments = {false, {each, 0.9 * each, 1.1 * each}, {1, 1, 1}};
    }
  c = only(of);
  EXPECT_EQ(c.method, Method::segments);
  EXPECT_EQ(c.verdict, Verdict::worse);
  EXPECT_TRUE(c.on_these_data());
  EXPECT_FALSE(c.p);
}

TEST(Verdict, TakesTheMeanOverReplicatesAsOneInput) {
  const auto of = measured(
      {"a", "b"}, 6,
      [](std::size_t v, std::size_t k, std::size_t r) {
        const double noise = r == 0 ? 0.7 : 1 / 0.7;  // the same for both
        return std::optional(noise * (v == 0 ? 1 : 1.2 + 0.01 * static_cast<double>(k)));
      },
      2);
  const Contrast c = only(of);
  EXPECT_EQ(c.by_input.size(), 6u);
  EXPECT_NEAR(c.by_input[3], std::log(1.23), 1e-12);
  EXPECT_EQ(c.method, Method::sign_flip);
  EXPECT_DOUBLE_EQ(*c.p, 2.0 / 64);
  EXPECT_EQ(c.verdict, Verdict::worse);
}

TEST(Verdict, OfAVariantThatFailsOnAnInputIsNotBetter) {
  const auto of = [](std::optional<std::size_t> fails, double factor) {
    return measured({"a", "b"}, 7, [=](std::size_t v, std::size_t k, std::size_t) {
      const double value = (v == 0 ? 1 : factor) * (1 + 0.01 * static_cast<double>(k));
      return v == 1 && k == fails ? std::nullopt : std::optional(value);
    });
  };
  EXPECT_EQ(only(of(std::nullopt, 0.5)).verdict, Verdict::better);
  const Contrast c = only(of(3, 0.5));
  EXPECT_EQ(c.verdict, Verdict::fails);
  EXPECT_EQ(c.failed_inputs, 1u);
  EXPECT_THAT(c.inputs, ElementsAre(0, 1, 2, 4, 5, 6));
  EXPECT_EQ(only(of(3, 1)).verdict, Verdict::fails);
  EXPECT_EQ(only(of(3, 2)).verdict, Verdict::worse);
}

TEST(Verdict, OfAVariantThatAlwaysFailsIsThatItFails) {
  const auto of = measured({"a", "b"}, 6, [](std::size_t v, std::size_t, std::size_t) {
    return v == 0 ? std::optional(1.0) : std::nullopt;
  });
  EXPECT_EQ(only(of).verdict, Verdict::fails);
  EXPECT_EQ(only(of).failed_inputs, 6u);
  EXPECT_EQ(of.failures(), 6u);
}

TEST(Verdict, IsNotBetterForWhatTheReferenceFails) {
  const auto of = measured({"a", "b"}, 7, [](std::size_t v, std::size_t k, std::size_t) {
    return v == 0 && k == 0 ? std::nullopt
                            : std::optional(1.0 + 0.001 * static_cast<double>(v * k));
  });
  EXPECT_EQ(only(of).verdict, Verdict::equivalent);
  EXPECT_EQ(only(of).failed_inputs, 0u);
}

TEST(Verdict, AdjustsTheNumberThatDecidesForItsVariants) {
  // Each of three variants is a fifth higher on all of six inputs: p = 2 / 64 for each, 6 / 64 for
  // all, which proves nothing.
  const auto value = [](std::size_t v, std::size_t k, std::size_t) {
    return std::optional(v == 0 ? 1 : 1.2 + 0.01 * static_cast<double>(k + v));
  };
  const auto of_six = judge(measured({"a", "b", "c", "d"}, 6, value), rules());
  for (const Contrast& c : of_six.front().contrasts) {
    EXPECT_DOUBLE_EQ(*c.p, 2.0 / 64);
    EXPECT_DOUBLE_EQ(*c.adjusted_p, 6.0 / 64);
    EXPECT_DOUBLE_EQ(c.least_p, 6.0 / 64);
    EXPECT_FALSE(c.least_shown);
    EXPECT_EQ(c.verdict, Verdict::large);
  }
  const auto of_seven = judge(measured({"a", "b", "c", "d"}, 7, value), rules());
  for (const Contrast& c : of_seven.front().contrasts) EXPECT_EQ(c.verdict, Verdict::worse);
  Rules other = rules();
  other.primary = "something else";
  const auto exploratory = judge(measured({"a", "b", "c", "d"}, 6, value), other);
  EXPECT_FALSE(exploratory.front().primary);
  EXPECT_EQ(exploratory.front().contrasts[1].verdict, Verdict::worse);
}

TEST(Verdict, SaysTheSmallestDifferenceThatCouldHaveBeenShown) {
  const Contrast c = only(six(1, 0.1, 4));
  ASSERT_TRUE(c.least_shown && c.interval);
  const double shift = *c.least_shown - c.estimate;
  // Moved so that its mean is that difference, the interval just leaves 0 out.
  EXPECT_GE(c.interval->low + shift, -1e-12);
  EXPECT_GE(*c.least_shown, c.interval->high - c.estimate - 1e-12);
}

TEST(Verdict, OfCountsIsByTheirDifference) {
  const auto of = measured(
      {"a", "b"}, 6,
      [](std::size_t v, std::size_t k, std::size_t) {
        return std::optional(v == 0 ? 0.0 : 2 + static_cast<double>(k));
      },
      1, "matching iterations", "");
  Rules by;
  by.primary = "matching iterations";
  const auto all = judge(of, by);
  EXPECT_EQ(all.front().scale, Scale::difference);
  EXPECT_DOUBLE_EQ(all.front().contrasts[0].estimate, 4.5);
  EXPECT_EQ(all.front().contrasts[0].verdict, Verdict::worse);
  by.higher_is_better = {"matching*"};
  EXPECT_EQ(judge(of, by).front().contrasts[0].verdict, Verdict::better);
}

TEST(Verdict, OfErrorsOfWhichOneIsZeroIsByTheirDifference) {
  const auto of = measured({"a", "b"}, 6, [](std::size_t v, std::size_t k, std::size_t) {
    return std::optional(k == 0 ? 0.0 : 1 + 0.01 * static_cast<double>(v));
  });
  EXPECT_EQ(judge(of, rules()).front().scale, Scale::difference);
  EXPECT_EQ(only(of).verdict, Verdict::equivalent);  // 0.0083 of 0.83
}

TEST(Verdict, DoesNotCompareTimesOfWhatCameFromACache) {
  Measured of = measured(
      {"a", "b"}, 6,
      [](std::size_t v, std::size_t, std::size_t) {
        return std::optional(1.0 + 9.0 * static_cast<double>(v));
      },
      1, "time", "CPU s");
  of.at(1, 2).figures.front().from_cache = true;
  EXPECT_THAT(only(of).inputs, ElementsAre(0, 1, 3, 4, 5));
  EXPECT_EQ(only(of).failed_inputs, 0u);
  for (std::size_t k = 0; k < 6; ++k) of.at(1, k).figures.front().from_cache = true;
  EXPECT_TRUE(judge(of, rules()).front().contrasts.empty());
}

TEST(Verdict, LeavesOutNumbersThatTheReferenceOrAllOthersNeverGive) {
  Measured of = six(1, 0.1, 1);
  of.at(0, 0).figures.push_back({{"of a alone", 1, "m"}});
  of.at(1, 0).figures.push_back({{"of b alone", 1, "m"}});
  EXPECT_EQ(judge(of, rules()).size(), 1u);
}

TEST(JudgeAgainst, HoldsEachVariantAgainstWhatItWas) {
  const auto value = [](double factor) {
    return [factor](std::size_t v, std::size_t k, std::size_t) {
      return std::optional((v == 0 ? 1 : factor) * (1 + 0.01 * static_cast<double>(k)));
    };
  };
  Measured then = measured({"a", "b"}, 6, value(1)), now = measured({"b", "a"}, 6, value(1.3));
  for (std::size_t k = 0; k < 6; ++k) {
    then.at(0, k).figures.push_back({{"time", 1, "CPU s"}});
    now.at(0, k).figures.push_back({{"time", 9, "CPU s"}});
  }
  const auto all = judge_against(then, now, rules());
  ASSERT_EQ(all.size(), 1u) << "times are of another day";
  ASSERT_EQ(all.front().contrasts.size(), 2u);
  EXPECT_EQ(all.front().contrasts[0].variant, "b");
  EXPECT_EQ(all.front().contrasts[0].verdict, Verdict::equivalent);
  EXPECT_EQ(all.front().contrasts[1].variant, "a");
  EXPECT_NEAR(std::exp(all.front().contrasts[1].estimate), 1.3, 1e-12);
}

TEST(JudgeAgainst, LeavesOutInputsThatAreOthers) {
  const auto one = [](std::size_t, std::size_t, std::size_t) { return std::optional(1.0); };
  const Measured then = measured({"a"}, 3, one);
  Measured now = measured({"a"}, 3, one);
  now.inputs[1].bytes += 1;
  EXPECT_THAT(judge_against(then, now, rules()).front().contrasts.front().inputs,
              ElementsAre(0, 2));
}

}  // namespace
}  // namespace plumb::experiment
