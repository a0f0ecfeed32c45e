#include "plumb/slam/report/comparison.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/slam/types.hpp"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A run of a pipeline with a matcher, a step `error` that measures two stages, and a step
/// `map_error`.
struct SmallRun {
  StepDescription matcher, measure, map_measure;
  Plan plan;
  RunResult result;

  SmallRun() {
    matcher.name = "register.any", measure.name = "measure.any", map_measure.name = "measure.map";
    InputDescription port;
    port.access = Access::several;
    measure.inputs.push_back(port);
    PlannedStep matched, error, map_error;
    matched.path = "fine.matched", matched.description = &matcher;
    error.path = "error", error.description = &measure;
    map_error.path = "map_error", map_error.description = &map_measure;
    Wire before, fine;
    before.label = "before", fine.label = "fine";
    error.inputs = {{before, fine}};
    plan.steps = {matched, error, map_error};
    Metrics errors, of_map, of_matches;
    errors.add("before.ate", 2, "m").add("fine.ate", 0.1, "m").add("fine.rpe", nan, "m");
    of_map.add("mean", 0.03, "m");
    of_matches.add("rmse", 0.2, "m");
    result.numbers = {{"fine.matched", any_value<Metrics>(of_matches)},
                      {"error", any_value<Metrics>(errors)},
                      {"map_error", any_value<Metrics>(of_map)}};
    result.times = {{"fine.matched", 3, 0, 1.5}, {"error", 1, 0, 0.25}};
    result.counts = {{"fine.matched", "iterations", 12},
                     {"fine.matched", "registrations not accepted", 1},
                     {"error", "iterations", 7}};
  }

  std::vector<std::string> texts(const ComparedFigures& chosen = {}) const {
    std::vector<std::string> texts;
    for (const Number& n : figures_of(plan, result, chosen)) {
      std::ostringstream text;
      text << n.name << " " << n.value << " " << n.unit;
      texts.push_back(text.str());
    }
    return texts;
  }
};

TEST(Comparison, TakesTheErrorsOfTheLastStageAndTheTimeOfMatching) {
  EXPECT_THAT(SmallRun().texts(),
              ElementsAre("error.fine.ate 0.1 m", "map_error.mean 0.03 m",
                          "matching time 1.5 CPU s", "matching iterations 12 ", "time 1.75 CPU s"));
}

TEST(Comparison, TakesWhatIsAskedForOfAnyStepAndStage) {
  EXPECT_THAT(
      SmallRun().texts({{"*.ate", "*.before.*", "fine.matched.rmse"}, {"measure.a"}}),
      ElementsAre("fine.matched.rmse 0.2 m", "error.before.ate 2 m", "error.fine.ate 0.1 m",
                  "measure.a* time 0.25 CPU s", "measure.a* iterations 7 ", "time 1.75 CPU s"));
}

TEST(Comparison, OfANumberThatNoStepGivesIsRefusedWithOneThatThereIs) {
  EXPECT_THAT(io::refusal([] { SmallRun().texts({{"error.fine.atr"}}); }),
              AllOf(HasSubstr("'error.fine.atr'"), HasSubstr("'error.fine.ate'")));
}

std::vector<Number> ate(double value) { return {{"ate", value, "m"}}; }

TEST(Comparison, SaysHowMuchLessAndHowSureThatIs) {
  // Differences 0.4, 0.5, 0.9: mean 0.6, standard error sqrt(0.07 / 3), t of 2 degrees of
  // freedom 4.3027.
  const auto made = compare({"ours", "theirs"}, {"a", "b", "c"},
                            {{ate(0.6), ate(0.5), ate(0.1)}, {ate(1), ate(1), ate(1)}});
  ASSERT_EQ(made.numbers.size(), 1u);
  const auto less = made.numbers[0].less_than(1);
  EXPECT_NEAR(less.percent, 60, 1e-9);
  ASSERT_TRUE(less.interval);
  EXPECT_NEAR(*less.interval, 100 * 4.3027 * std::sqrt(0.07 / 3), 1e-9);
  EXPECT_THAT(
      comparison_table(made),
      AllOf(HasSubstr("60.0 % +- 65.7"), HasSubstr("Means over 3 inputs"), HasSubstr("ate [m]")));
}

TEST(Comparison, OfOneInputHasNoInterval) {
  const auto made = compare({"ours", "theirs"}, {"a"}, {{ate(3)}, {ate(2)}});
  EXPECT_FALSE(made.numbers[0].less_than(1).interval);
  EXPECT_THAT(comparison_table(made), AllOf(HasSubstr("-50.0 %"), Not(HasSubstr("+-"))));
}

TEST(Comparison, OfVariantsThatDifferByTheSameEverywhereIsCertain) {
  const auto made = compare({"ours", "theirs"}, {"a", "b"}, {{ate(1), ate(2)}, {ate(2), ate(3)}});
  EXPECT_NEAR(made.numbers[0].less_than(1).percent, 40, 1e-9);
  EXPECT_NEAR(*made.numbers[0].less_than(1).interval, 0, 1e-9);
}

TEST(Comparison, LeavesADashForAVariantThatNeverGivesTheNumber) {
  const std::vector<Number> both{{"ate", 1, "m"}, {"iterations", 5, ""}},
      more{{"ate", 2, "m"}, {"iterations", 10, ""}};
  const auto made = compare({"ours", "theirs", "peer"}, {"a", "b"},
                            {{both, both}, {more, more}, {ate(4), ate(4)}});
  ASSERT_EQ(made.numbers.size(), 2u);
  EXPECT_NEAR(made.numbers[1].less_than(1).percent, 50, 1e-9);
  EXPECT_TRUE(std::isnan(made.numbers[1].mean(2)));
  EXPECT_THAT(comparison_table(made), HasSubstr("     -     50.0 % +- 0.0               -\n"));
  EXPECT_FALSE(
      nlohmann::json::parse(comparison_json(made))["numbers"][1]["variants"].contains("peer"));
}

TEST(Comparison, KeepsOnlyWhatVariantsGiveOnTheSameInputsAndSaysOnHowMany) {
  const std::vector<Number> both{{"ate", 1, "m"}, {"iterations", 5, ""}};
  const auto made = compare({"ours", "theirs"}, {"a", "b"}, {{both, {}}, {ate(2), ate(8)}});
  ASSERT_EQ(made.numbers.size(), 1u);
  EXPECT_THAT(made.numbers[0].inputs, ElementsAre(0));
  EXPECT_THAT(comparison_table(made), HasSubstr("ate [m] (1 of 2 inputs)"));
}

TEST(Comparison, WithNothingIsADashAndNull) {
  const auto made = compare({"ours", "theirs", "none"}, {"a"}, {{ate(1)}, {ate(4)}, {ate(0)}});
  EXPECT_THAT(comparison_table(made), AllOf(HasSubstr("less than theirs  less than none"),
                                            HasSubstr("75.0 %               -\n")));
  const auto json = nlohmann::json::parse(comparison_json(made));
  EXPECT_TRUE(json["numbers"][0]["variants"]["none"]["less_by"].is_null());
  EXPECT_NEAR(json["numbers"][0]["variants"]["theirs"]["less_by"].get<double>(), 75, 1e-9);
  EXPECT_THAT(json["numbers"][0]["variants"]["ours"]["values"].get<std::vector<double>>(),
              ElementsAre(1));
}

/// The probability that |t| is below `bound`, by Simpson's rule.
double within(double bound, double freedom) {
  const double scale = std::exp(std::lgamma((freedom + 1) / 2) - std::lgamma(freedom / 2)) /
                       std::sqrt(freedom * std::numbers::pi);
  const auto density = [&](double t) {
    return scale * std::pow(1 + t * t / freedom, -(freedom + 1) / 2);
  };
  constexpr int steps = 4000;
  double sum = density(0) + density(bound);
  for (int k = 1; k < steps; ++k) sum += (k % 2 ? 4 : 2) * density(bound * k / steps);
  return 2 * sum * bound / steps / 3;
}

TEST(Comparison, StudentsTHoldsNineteenOfTwenty) {
  for (const std::size_t freedom : {1, 2, 4, 9, 10, 11, 15, 40, 1000})
    EXPECT_NEAR(within(student_t(freedom), static_cast<double>(freedom)), 0.95, 2e-5) << freedom;
}

}  // namespace
}  // namespace plumb
