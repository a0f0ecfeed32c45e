/// Steps that wait for nothing run at the same time, and nobody can tell from what the run gives.
#include <gmock/gmock.h>

#include <set>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/meeting_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

using engine_test::meeting;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string source =
    "plumb: 1\nname: together\nsteps:\n  source: {use: test.source, with: {frames: 60}}\n";

struct Together : testing::Test {
  const io::TestFolder folder;
  const Registry steps = engine_test::meeting_registry();

  RunResult run(const std::string& more, unsigned threads, Store* store = nullptr) {
    const Plan plan = read_pipeline(folder.write("together.yaml", source + more), {}, steps);
    Observers silent;
    RunOptions options;
    options.threads = threads;
    options.store = store;
    meeting.begin();
    return run_plan(plan, steps, options, silent);
  }
  static std::string text_of(const RunResult& result) {
    std::string text;
    for (const auto& made : result.documents) text += made.document->bytes.text();
    return text;
  }
};

const std::string two =
    R"(  left: {use: test.meet, from: source.poses, with: {name: left, other: right}}
  right: {use: test.meet, from: source.poses, with: {name: right, other: left}}
  out: {use: test.write, from: {metrics: {left: left.metrics, right: right.metrics}}}
)";

TEST_F(Together, TwoStepsMeet) { EXPECT_EQ(text_of(run(two, 2)), "left met=1\nright met=1\n"); }

TEST_F(Together, OneThreadTakesThemInThePlansOrder) {
  run(R"(  a: {use: test.meet, from: source.poses, with: {name: a}}
  b: {use: test.meet, from: source.poses, with: {name: b}}
  loop:
    repeat:
      passes: {times: [1, 2]}
      carry: {poses: d}
    start: {poses: source.poses}
    steps:
      c: {use: test.meet, from: poses, with: {name: c, times: $times}}
      d: {use: test.meet, from: c.poses, with: {name: d, times: $times}}
  e: {use: test.meet, from: b.poses, with: {name: e}}
  f: {use: test.meet, from: source.poses, with: {name: f}}
)",
      1);
  EXPECT_THAT(meeting.names(), ElementsAre("a", "b", "c", "d", "c", "d", "e", "f"));
}

TEST_F(Together, AStepOfOneCallLetsAnotherOnesItemsBeMadeMeanwhile) {
  const std::string more =
      R"(  whole: {use: test.meet, from: source.poses, with: {name: whole, other: item, times: 20}}
  items: {use: test.tell, from: {range: source.ranges}, with: {name: item}}
  sum: {use: test.gauge, from: {features: items, poses: source.poses}}
  out: {use: test.write, from: {metrics: {whole: whole.metrics}}}
)";
  EXPECT_EQ(text_of(run(more, 2)), "whole met=1\n");
}

TEST_F(Together, AThreadThatHasNothingToBeginHelpsWithTheItemsOfAnotherStep) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "threads of the pool's double help in their own loops alone";
#endif
  const std::string more =
      R"(  first: {use: test.meet, from: source.poses, with: {name: first, other: item}}
  items: {use: test.tell, from: {range: source.ranges}, with: {name: item, together: 2}}
  sum: {use: test.gauge, from: {features: items, poses: source.poses}}
  out: {use: test.write, from: {metrics: {first: first.metrics}}}
)";
  for (int again = 0; again < 3; ++again) EXPECT_EQ(text_of(run(more, 2)), "first met=1\n");
}

TEST_F(Together, ARepeatGoesThroughItsPassesBesideAStep) {
  const std::string more = R"(  loop:
    repeat:
      passes: {times: [1, 1, 1]}
      carry: {poses: inside}
    start: {poses: source.poses}
    steps:
      inside: {use: test.meet, from: poses, with: {name: inside, other: outside, times: $times}}
  outside: {use: test.meet, from: source.poses, with: {name: outside, other: inside, times: 3}}
  out: {use: test.write, from: {metrics: {in: loop.inside.metrics, out: outside.metrics}}}
)";
  EXPECT_EQ(text_of(run(more, 2)), "in met=1\nout met=1\n");
}

TEST_F(Together, AFailureIsToldAndTheRestOfAStepThatRunsIsLeftOut) {
  const std::string more =
      R"(  fails: {use: test.meet, from: source.poses, with: {name: fails, other: item, fail: true}}
  items: {use: test.tell, from: {range: source.ranges}, with: {name: item, other: failure}}
  sum: {use: test.gauge, from: {features: items, poses: source.poses}, with: {name: sum}}
)";
  EXPECT_EQ(io::refusal([&] { run(more, 2); }), "step 'fails' (test.meet): has had enough");
  EXPECT_GE(meeting.count("item"), 1u);
  EXPECT_LT(meeting.count("item"), 20u);
  EXPECT_EQ(meeting.count("sum"), 0u);
}

TEST_F(Together, OfTwoFailuresTheFirstInThePlanIsTold) {
  const std::string more =
      R"(  first: {use: test.meet, from: source.poses, with: {name: first, other: second, fail: true}}
  second: {use: test.meet, from: source.poses, with: {name: second, other: first, fail: true}}
)";
  for (int again = 0; again < 20; ++again)
    EXPECT_THAT(io::refusal([&] { run(more, 2); }), HasSubstr("step 'first'"));
}

TEST_F(Together, WithABoundOfMemoryStepsRunOneAfterTheOther) {
  const std::string more = R"(  a: {use: test.meet, from: source.poses, with: {name: a}}
  b: {use: test.meet, from: source.poses, with: {name: b}}
  c: {use: test.meet, from: a.poses, with: {name: c}}
)";
  const Plan plan = read_pipeline(folder.write("together.yaml", source + more), {}, steps);
  Store store(folder.path() / "store");
  Observers silent;
  RunOptions options;
  options.threads = 4;
  options.store = &store;
  options.memory = std::size_t{1} << 30;
  meeting.begin();
  run_plan(plan, steps, options, silent);
  EXPECT_THAT(meeting.names(), ElementsAre("a", "b", "c"));
}

/// Three loops and four steps beside them, two of which may give the same.
std::string wide() {
  std::string text, metrics;
  for (const std::string name : {"a", "b", "c"}) {
    text += "  " + name + R"(:
    repeat:
      passes: {times: [1, 2, 3]}
      carry: {poses: gauged}
    start: {poses: source.poses}
    steps:
      told: {use: test.tell, from: {range: source.ranges, poses: poses}, with: {name: )" +
            name + R"(, times: $times}}
      gauged: {use: test.gauge, from: {features: told, poses: poses}, with: {name: )" +
            name + "}}\n";
    metrics += name + ": " + name + ".gauged.metrics, ";
  }
  for (const std::string name : {"d", "e", "f", "g"}) {
    const std::string who = name == "g" ? "f" : name;  // f and g are alike
    text += "  told_" + name +
            ": {use: test.tell, from: {range: source.ranges}, with: {name: " + who + "}}\n  " +
            name + ": {use: test.gauge, from: {features: told_" + name +
            ", poses: source.poses}, with: {name: " + who + "}}\n";
    metrics += name + ": " + name + ".metrics, ";
  }
  return text +
         "  kept: {use: test.keep, from: source.frames}\n  all: {use: test.sum, from: kept}\n"
         "  again: {use: test.sum, from: source.frames}\n"
         "  out: {use: test.write, from: {metrics: {" +
         metrics + "all: all, again: again}}}\n";
}

/// All that a run says at its end but times.
std::string told(const RunResult& result) {
  std::string text;
  for (const auto& made : result.documents) text += made.document->bytes.text();
  for (const auto& numbers : result.numbers)
    text += numbers.path + numbers.value.hash().text() + "\n";
  for (const LoopEnd& loop : result.loops)
    text += loop.path + " " + std::to_string(loop.passes) + " " + loop.why + "\n";
  for (const std::string& warning : result.warnings) text += warning + "\n";
  for (const StepCount& count : result.counts) text += count.text() + "\n";
  for (const StepTime& time : result.times)
    text +=
        time.path + " " + std::to_string(time.items) + " " + std::to_string(time.remembered) + "\n";
  for (const Explained& explained : result.explained) text += explained.text() + "\n";
  return text;
}

TEST_F(Together, WhatARunSaysIsTheSameForAnyNumberOfThreads) {
  const std::string more = wide(), expected = told(run(more, 1));
  EXPECT_THAT(expected, HasSubstr("a.gauged: 3 collections summed"));
  EXPECT_THAT(expected, HasSubstr("told_d: frame 6"));
  for (int again = 0; again < 20; ++again)
    for (const unsigned threads : {2u, 8u}) ASSERT_EQ(told(run(more, threads)), expected);
}

TEST_F(Together, WhatARunSaysWithACacheIsTheSameForAnyNumberOfThreads) {
  const std::string more = wide();
  std::set<std::string> first, second;
  for (const unsigned threads : {1u, 2u, 8u, 2u, 8u}) {
    const io::TestFolder cache;
    Store store(cache.path() / "store");
    first.insert(told(run(more, threads, &store)));
    second.insert(told(run(more, threads, &store)));
  }
  ASSERT_EQ(first.size(), 1u);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_THAT(*first.begin(), HasSubstr("told_f: made, all 20"));
  EXPECT_THAT(*first.begin(), HasSubstr("told_g: reused, all 20"));
  EXPECT_THAT(*first.begin(), HasSubstr("a.gauged, pass 3: made"));
  EXPECT_THAT(*second.begin(), HasSubstr("told_d: reused, all 20"));
}

}  // namespace
}  // namespace plumb
