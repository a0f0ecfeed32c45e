#include <gmock/gmock.h>

#include <cmath>

#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

/// A contrast with its interval, all given as ratios.
Contrast ratios(double estimate, double low, double high, Verdict verdict = Verdict::not_shown) {
  Contrast made;
  made.variant = "B";
  made.inputs = {0};
  made.by_input = {std::log(estimate)};
  made.estimate = std::log(estimate);
  made.interval = Interval{std::log(low), std::log(high)};
  made.method = Method::sign_flip;
  made.verdict = verdict;
  return made;
}

Judged number(const std::string& unit, Scale scale = Scale::ratio) {
  return {"error.fine.ate", unit, scale, true, false, {}};
}

std::string said(const std::string& unit, const Contrast& contrast) {
  return sentence(number(unit), contrast, "A", 6);
}

TEST(Sentence, NeverSaysLessByMinusTenPercent) {
  EXPECT_EQ(said("CPU s", ratios(0.88, 0.8, 0.97, Verdict::better)),
            "B takes 12 % less than A (3 to 20 %): better");
  EXPECT_EQ(said("CPU s", ratios(1.1, 1.02, 1.2, Verdict::worse)),
            "B takes 10 % more than A (2 to 20 %): worse");
  EXPECT_EQ(said("m", ratios(0.88, 0.8, 0.97, Verdict::better)),
            "B is 12 % lower than A (3 to 20 %): better");
}

TEST(Sentence, OfAnIntervalOnBothSidesSaysBoth) {
  EXPECT_EQ(said("m", ratios(0.99, 0.95, 1.031)),
            "B is 1 % lower than A (5 % lower to 3.1 % higher): not shown");
  EXPECT_EQ(said("m", ratios(1.2, 0.9, 1.5, Verdict::large)),
            "B is 20 % higher than A (10 % lower to 50 % higher): large, not proven");
}

TEST(Sentence, SaysWhereItHolds) {
  Contrast c = ratios(0.5, 0.4, 0.6, Verdict::better);
  c.method = Method::segments;
  EXPECT_EQ(said("m", c), "B is 50 % lower than A (40 to 60 %): better, on these data");
  c = ratios(1, 1, 1, Verdict::equivalent);
  c.method = Method::identical;
  EXPECT_EQ(said("m", c), "B is the same as A: equivalent");
}

TEST(Sentence, SaysWhatFailed) {
  Contrast c = ratios(0.5, 0.4, 0.6, Verdict::fails);
  c.failed_inputs = 1;
  EXPECT_EQ(said("m", c), "B is 50 % lower than A (40 to 60 %): no result on 1 of 6 inputs");
  c = Contrast();
  c.variant = "B";
  c.verdict = Verdict::fails;
  c.failed_inputs = 6;
  EXPECT_EQ(said("m", c), "B gives nothing to hold against A: no result on 6 of 6 inputs");
}

TEST(Sentence, OfCountsHasTheirDifference) {
  Contrast c = ratios(1, 1, 1, Verdict::worse);
  c.by_input = {3.5};
  c.estimate = 3.5;
  c.interval = Interval{1, 6.25};
  EXPECT_EQ(sentence(number("", Scale::difference), c, "A", 6),
            "B has 3.5 more than A (1 to 6.25): worse");
  EXPECT_EQ(sentence(number("m", Scale::difference), c, "in old.json", 6),
            "B is 3.5 m higher than in old.json (1 to 6.25 m): worse");
}

}  // namespace
}  // namespace plumb::experiment
