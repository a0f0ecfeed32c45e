#include "plumb/engine/run/runner.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "plumb/data/error.hpp"
#include "plumb/engine/plan/loop.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

using engine_test::frames_opened, engine_test::pairs_made, engine_test::shifted_made;
using testing::HasSubstr;

const std::string cascade = "plumb: 1\nname: cascade\nabout: a loop that halves\n" +
                            engine_test::halving_steps + R"(  sums: {use: test.sum, from: kept}
  out: {use: test.write, from: {metrics: {last: loop.solved.metrics, sums: sums}}}
)";

struct Engine : testing::Test {
  Registry steps = engine_test::registry();
  std::filesystem::path file = std::filesystem::temp_directory_path() /
                               ("plumb_engine_" + std::to_string(getpid()) + ".yaml");

  Engine() { frames_opened = pairs_made = shifted_made = 0; }
  ~Engine() override { std::filesystem::remove(file); }

  RunResult run(const std::string& yaml, std::vector<std::string> sets = {}, unsigned threads = 2) {
    std::ofstream(file) << yaml;
    Overlay overlay;
    overlay.sets = std::move(sets);
    const Plan plan = read_pipeline(file, overlay, steps);
    Observers silent;
    RunOptions options;
    options.threads = threads;
    return run_plan(plan, steps, options, silent);
  }
};

TEST_F(Engine, RunsACascadeAndCarriesPosesFromPassToPass) {
  const RunResult result = run(cascade);
  ASSERT_EQ(result.documents.size(), 1u);
  // Four segments 24 m apart: 3 edges of 24, then 12, then 6 m; gates 4, 2, 1. The sum: of
  // 2^(11-k) k for k = 0..11.
  EXPECT_EQ(result.documents[0].document->bytes.text(),
            "last gap=18 gates=3\nsums sum=4083 frames=12\n");
  ASSERT_EQ(result.loops.size(), 1u);
  EXPECT_EQ(result.loops[0].passes, 3);
}

TEST_F(Engine, MakesWhatDoesNotSeePosesOnceForAllPasses) {
  run(cascade);
  EXPECT_EQ(pairs_made, 3);
  EXPECT_EQ(shifted_made, 9);
}

TEST_F(Engine, OpensEachFrameOnceForEachWhoTakesIt) {
  run(cascade);
  EXPECT_EQ(frames_opened, 24);  // merging and the sum
}

TEST_F(Engine, SumsCountsOverItemsEachOnceHoweverOftenItIsMade) {
  const auto counts = run(cascade).counts;
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts[0].text(), "kept: 12 frames seen");
}

TEST_F(Engine, GivesTheSameBytesForOneAndForTwoThreads) {
  EXPECT_EQ(run(cascade, {}, 1).documents[0].document->bytes.text(),
            run(cascade, {}, 2).documents[0].document->bytes.text());
}

TEST_F(Engine, RepeatsTheLastColumnUntilTheConditionHolds) {
  std::string yaml = cascade;
  yaml.replace(yaml.find("    start:"), 0,
               "      until: {all: [{metric: solved.gap, below: 1.5 m}]}\n      at_most: 9\n");
  const RunResult result = run(yaml);
  EXPECT_EQ(result.loops[0].passes, 7);  // 72, 36, 18, 9, 4.5, 2.25, 1.125
  EXPECT_THAT(result.loops[0].why, HasSubstr("1.125"));
  EXPECT_THAT(result.documents[0].document->bytes.text(), HasSubstr("gates=3"));
}

TEST(Loop, SaysWhyItEndsAndWhetherTheNumberRose) {
  PlannedRepeat repeat;
  repeat.at_least = 2;
  repeat.at_most = 9;
  repeat.conditions.resize(1);
  repeat.conditions[0].falls_by_less_than = 0.02;
  repeat.conditions[0].metric_text = "rmse";
  repeat.conditions[0].text = "rmse falls by less than 2 %";
  const auto ended = [&](double first, double second) {
    LoopJudge judge(repeat);
    EXPECT_FALSE(judge.after_pass({first}));
    return judge.after_pass({second}).value_or("goes on");
  };
  EXPECT_EQ(ended(0.3, 0.2), "goes on");
  EXPECT_EQ(ended(0.2101357924, 0.2098765432), "rmse falls by less than 2 % (0.2101 -> 0.2099)");
  EXPECT_EQ(ended(0.2101357924, 0.2134246801), "rmse rose (0.2101 -> 0.2134)");
  EXPECT_EQ(ended(0.25, 0.25000001), "rmse falls by less than 2 % (it stays at 0.25)");
}

TEST_F(Engine, NamesTheStepAndTheFirstItemThatFails) {
  try {
    run(cascade, {"kept.refuse=4"}, 1);
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(),
                 "step 'kept' (test.keep), frame 4: will not; 2 further items of step 'merged' "
                 "failed: segment 2, segment 3");
  }
}

const char* const stitched = R"(plumb: 1
steps:
  source: {use: test.source}
  pieces: {use: test.merge, from: {frames: source.frames, ranges: source.ranges}}
  edges: {use: test.chain, from: pieces}
  groups: {use: test.stitch, from: pieces}
  laid: {use: test.lay, from: {edges: edges, targets: groups, sources: pieces}}
  solved: {use: test.halve, from: {matches: laid, poses: source.poses}}
  out: {use: test.write, from: {metrics: solved.metrics}}
)";

TEST_F(Engine, TakesManyValuesTogetherWithTheItemsThatTheyBelongTo) {
  // First points of the pieces: 0, 3, 6, 9; of the groups: 0, 0, 3, 6. Edges 0-1, 1-2, 2-3.
  EXPECT_THAT(run(stitched).documents[0].document->bytes.text(), HasSubstr("gap=15"));
}

TEST_F(Engine, RefusesManyValuesThatAreFewerThanTheirItems) {
  try {
    run(stitched, {"groups.lose=true"});
    FAIL() << "was not refused";
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(),
                 "step 'groups' (test.stitch): its output 'groups' has 3 values where its input "
                 "'segments' has 4; "
                 "the step must give one for each");
  }
}

TEST_F(Engine, ChangedRowsReachTheirSteps) {
  EXPECT_THAT(run(cascade, {"loop.gate=7m,5m"}).documents[0].document->bytes.text(),
              HasSubstr("gap=36 gates=15"));
}

}  // namespace
}  // namespace plumb
