#include "plumb/slam/report/figures.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <sstream>
#include <tuple>

#include "plumb/slam/types.hpp"

namespace plumb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A run of a pipeline with a matcher, a step `error` that measures two stages, a step `map_error`,
/// and one that measures the match RMSE of two stages.
struct SmallRun {
  StepDescription matcher, measure, map_measure, rmse_measure;
  Plan plan;
  RunResult result;

  SmallRun() {
    matcher.name = "register.any", measure.name = "measure.any", map_measure.name = "measure.map",
    rmse_measure.name = "measure.match_rmse";
    InputDescription port;
    port.access = Access::several;
    measure.inputs.push_back(port);
    rmse_measure.inputs.push_back(port);
    PlannedStep matched, error, map_error, rmse;
    matched.path = "fine.matched", matched.description = &matcher;
    error.path = "error", error.description = &measure;
    map_error.path = "map_error", map_error.description = &map_measure;
    rmse.path = "match_rmse", rmse.description = &rmse_measure;
    Wire before, fine;
    before.label = "before", fine.label = "fine";
    error.inputs = {{before, fine}};
    rmse.inputs = {{before, fine}};
    plan.steps = {matched, error, map_error, rmse};
    Metrics errors, of_map, of_matches, matches;
    errors.add("before.ate", 2, "m").add("fine.ate", 0.1, "m").add("fine.rpe", nan, "m");
    of_map.add("mean", 0.03, "m");
    of_matches.add("rmse", 0.2, "m");
    matches.add("before", 5, "m").add("fine", 0.3, "m");
    for (const auto& [i, j, residual] :
         {std::tuple<std::uint32_t, std::uint32_t, double>{0, 1, 0.2}, {1, 3, 0.4}, {0, 2, 0}}) {
      EdgeRecord edge;
      edge.i = i, edge.j = j, edge.residual = residual;
      edge.status = residual > 0 ? "accepted" : "no matches";
      matches.edges.push_back(edge);
    }
    result.numbers = {{"fine.matched", any_value<Metrics>(of_matches)},
                      {"error", any_value<Metrics>(errors)},
                      {"map_error", any_value<Metrics>(of_map)},
                      {"match_rmse", any_value<Metrics>(matches)}};
    result.times = {{"fine.matched", 3, 0, 1.5}, {"error", 1, 0, 0.25}};
    result.counts = {{"fine.matched", "iterations", 12},
                     {"fine.matched", "registrations not accepted", 1},
                     {"error", "iterations", 7}};
  }

  std::vector<std::string> texts(const ComparedFigures& chosen = {}) const {
    std::vector<std::string> texts;
    for (const experiment::Figure& figure : figures_of(plan, result, chosen)) {
      std::ostringstream text;
      text << figure.number.name << " " << figure.number.value << " " << figure.number.unit
           << (figure.from_cache ? " of a cache" : "");
      texts.push_back(text.str());
    }
    return texts;
  }
};

TEST(Figures, AreTheErrorsOfTheLastStageAndTheTimeOfMatching) {
  EXPECT_THAT(SmallRun().texts(),
              ElementsAre("error.fine.ate 0.1 m", "map_error.mean 0.03 m", "match_rmse.fine 0.3 m",
                          "matching time 1.5 CPU s", "matching iterations 12 ", "time 1.75 CPU s"));
}

TEST(Figures, AreWhatIsAskedForOfAnyStepAndStage) {
  EXPECT_THAT(
      SmallRun().texts({{"*.ate", "*.before.*", "fine.matched.rmse"}, {"measure.a"}}),
      ElementsAre("fine.matched.rmse 0.2 m", "error.before.ate 2 m", "error.fine.ate 0.1 m",
                  "measure.a* time 0.25 CPU s", "measure.a* iterations 7 ", "time 1.75 CPU s"));
}

TEST(Figures, HaveTheOneThatDecidesWhateverElseIsAskedFor) {
  EXPECT_THAT(SmallRun().texts({{"map_error.*"}, {"none."}, "fine.matched.rmse"}),
              ElementsAre("fine.matched.rmse 0.2 m", "map_error.mean 0.03 m", "time 1.75 CPU s"));
}

TEST(Figures, KnowTheMatchRmseByTheSegmentsWithAllTheirEdges) {
  const SmallRun run;
  for (const experiment::Figure& figure : figures_of(run.plan, run.result, {})) {
    EXPECT_EQ(figure.segments.size() > 0, figure.number.name == "match_rmse.fine");
    if (figure.number.name != "match_rmse.fine") continue;
    EXPECT_THAT(figure.segments.sum, ElementsAre(0.2, testing::DoubleNear(0.6, 1e-12), 0, 0.4));
    EXPECT_THAT(figure.segments.count, ElementsAre(1, 2, 0, 1));
    EXPECT_NEAR(figure.segments.value(), 0.3, 1e-12);
  }
}

TEST(Figures, MarkTimesThatWereSpentInAnEarlierRun) {
  SmallRun run;
  run.result.times[1].earlier = 1;  // `error` came from the cache, `fine.matched` was made
  EXPECT_THAT(run.texts({{"no"}}), ElementsAre("matching time 1.5 CPU s", "matching iterations 12 ",
                                               "time 1.75 CPU s of a cache"));
  run.result.times[0].items = 0;  // it passes through a call that nobody made
  EXPECT_THAT(run.texts({{"no"}})[0], HasSubstr("of a cache"));
}

TEST(Unmatched, NamesANumberThatThereIs) {
  const SmallRun run;
  EXPECT_EQ(unmatched({"error.*", "map_error.mean"}, run.result), "");
  EXPECT_THAT(unmatched({"error.*", "error.fine.atr"}, run.result),
              AllOf(HasSubstr("'error.fine.atr'"), HasSubstr("'error.fine.ate'")));
  EXPECT_THAT(unmatched({"x"}, RunResult()), HasSubstr("no step gave any"));
}

TEST(Unmatchable, NamesAStepThatThereIs) {
  const SmallRun run;
  const Plan& plan = run.plan;
  EXPECT_EQ(unmatchable({"error.fine.atr", "fine.matched.*", "map_*", "*.ate", "fi?e.*"}, plan), "")
      << "which numbers a step gives is known after a run";
  EXPECT_THAT(unmatchable({"error.*", "eror.fine.ate"}, plan),
              AllOf(HasSubstr("'eror.fine.ate'"), HasSubstr("there is, say, the step 'error'")));
  EXPECT_THAT(unmatchable({"fine.mached.rmse"}, plan), HasSubstr("the step 'fine.matched'"));
  for (const char* odd : {"error", "coarse.*", "errors.*", "ate"})
    EXPECT_THAT(unmatchable({odd}, plan), HasSubstr(odd)) << odd;
}

}  // namespace
}  // namespace plumb
