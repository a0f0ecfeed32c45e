#include "plumb/engine/plan/plan_text.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "plumb/engine/plan/depth.hpp"
#include "plumb/engine/plan/level.hpp"
#include "plumb/engine/plan/lifetime.hpp"
#include "plumb/engine/testing/drawn_plan.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

using engine_test::DrawnPlan;
using engine_test::FrameRange, engine_test::Segment, engine_test::SegmentStep;
using testing::ElementsAre, testing::HasSubstr, testing::Not;

/// A cloud to a cloud, one by one.
struct Trim : SegmentStep {
  struct In {
    One<Segment> segment;
  };
  struct Params {};
  struct Out {
    Segment segment;
  };
  static void describe(Declaration<Trim>& is) {
    is.name("test.trim").version(1).summary("Trims.").source("");
    is.input("segment", &In::segment, "").output("segment", &Out::segment, "");
  }
  Out run(const In& in, const Params&, Context&) const { return {*in.segment}; }
};

struct OfAPlan : testing::Test {
  Registry steps = engine_test::registry();
  std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("plumb_plan_" + std::to_string(getpid()) + ".yaml");

  OfAPlan() {
    static const StepOf<Trim> trim;
    steps.add(trim);
  }
  ~OfAPlan() override { std::filesystem::remove(file); }

  Plan read(const std::string& yaml) {
    std::ofstream(file) << "plumb: 1\nname: planned\nabout: a test\n" << yaml;
    return read_pipeline(file, {}, steps);
  }

  /// A source, its clouds in `merged`, `more` steps, and a loop that adjusts the edges' clouds.
  Plan with(const std::string& more, const std::string& clouds, const std::string& in_loop = "") {
    return read(R"(steps:
  source: {use: test.source}
  merged: {use: test.merge, from: {frames: source.frames, ranges: source.ranges}}
)" + more + R"(  edges: {use: test.chain, from: )" +
                clouds + R"(}
  loop:
    repeat:
      passes: {gate: [2 m, 1 m]}
      carry: {poses: solved}
    start: {poses: source.poses}
    steps:
)" + in_loop + R"(      pairs: {use: test.pair, from: {edges: edges, segments: )" +
                (in_loop.empty() ? clouds : "trimmed") + R"(}}
      near: {use: test.shift, from: {matches: pairs, poses: poses}, with: {gate: $gate}}
      solved: {use: test.halve, from: {matches: near, poses: poses}}
  out: {use: test.write, from: {metrics: loop.solved.metrics}}
)");
  }

  /// "passing: large, and only voxels takes them"
  static std::string lifetime(const Plan& plan, const std::string& path) {
    const auto lifetimes = keeping_of(plan);
    for (std::size_t s = 0; s < plan.steps.size(); ++s) {
      if (plan.steps[s].path != path) continue;
      const Keeping keeping = lifetimes[s].keeping;
      return (keeping == Keeping::passing ? "passing: "
              : keeping == Keeping::kept  ? "kept: "
                                          : "remembered: ") +
             lifetimes[s].why;
    }
    return "no step '" + path + "'";
  }
};

TEST_F(OfAPlan, EveryStepHasALineThatSaysWhatItSeesAndWhyItsResultsLiveSoLong) {
  const std::string text =
      plan_text(read(engine_test::halving_steps + R"(  sums: {use: test.sum, from: kept}
  out: {use: test.write, from: {metrics: {last: loop.solved.metrics, sums: sums}}}
)"));
  const std::string table =
      R"(group   step            one call sees          results     until       why
1       source          whole collections      kept        sums        all but frames, opened whenever asked for
2       kept            one frame of source    passing     sums        frames are transient, made for each of 2 inputs
3       merged          one segment of source  kept        loop        large, but 2 inputs take them
4       edges           whole collections      kept        loop        one call makes all
5       loop: 3 passes
loop/1    loop.pairs    one edge of edges      remembered  loop        in a repeat
loop/2    loop.near     one edge of edges      remembered  loop        in a repeat
loop/3    loop.solved   whole collections      remembered  out         in a repeat
3       sums            whole collections      kept        out         one call makes all
6       out             whole collections      kept        end of run  one call makes all
results: )";
  EXPECT_EQ(text.substr(0, table.size()), table);
  EXPECT_THAT(text, HasSubstr("one after the other\n  3: merged, sums\nmemory: known"));
}

TEST_F(OfAPlan, WhatHasNoStepBesideItIsInNoListOfGroups) {
  EXPECT_THAT(plan_text(with("", "merged")), Not(HasSubstr("run together")));
}

TEST_F(OfAPlan, LargeItemsPassOnlyToOneStepThatTakesThemOneByOne) {
  const std::string trimmed = "  trimmed: {use: test.trim, from: merged}\n";
  EXPECT_EQ(lifetime(with(trimmed, "trimmed"), "merged"),
            "passing: large, and only trimmed takes them");
  EXPECT_EQ(lifetime(with(trimmed, "trimmed"), "trimmed"), "kept: large, but 2 inputs take them");
}

TEST_F(OfAPlan, LargeItemsAreKeptForAStepThatSeesSeveralOrAsksInEachPass) {
  const std::string in_loop = "      trimmed: {use: test.trim, from: first}\n";
  const std::string first = "  first: {use: test.trim, from: merged}\n";
  const Plan plan = with(first, "merged", in_loop);
  EXPECT_EQ(lifetime(plan, "first"),
            "remembered: large, but loop.trimmed takes them in each pass; "
            "test.trim occurs 2 times");
  EXPECT_EQ(lifetime(plan, "loop.trimmed"),
            "remembered: large, but loop.pairs takes several in a call; in a repeat");
  const Plan alone = read(R"(steps:
  source: {use: test.source}
  merged: {use: test.merge, from: {frames: source.frames, ranges: source.ranges}}
  edges: {use: test.chain, from: merged}
  near: {use: test.pair, from: {edges: edges, segments: merged}}
  solved: {use: test.halve, from: {matches: near, poses: source.poses}}
  out: {use: test.write, from: {metrics: solved.metrics}}
)");
  EXPECT_EQ(lifetime(alone, "near"), "kept: not large");
}

TEST_F(OfAPlan, ItemsOfAStepThatOccursAgainAreRemembered) {
  const Plan plan = read(R"(steps:
  source: {use: test.source}
  kept: {use: test.keep, from: source.frames}
  sums: {use: test.sum, from: kept}
  all: {use: test.sum, from: source.frames}
  out: {use: test.write, from: {metrics: {sums: sums, all: all}}}
)");
  EXPECT_EQ(lifetime(plan, "sums"), "remembered: test.sum occurs 2 times");
  EXPECT_EQ(lifetime(plan, "kept"), "passing: frames are transient");
}

TEST(Depths, CountTheLongestPathWithinALevelAlsoThroughWhatARepeatHolds) {
  DrawnPlan drawn;
  drawn.add({});      // 0
  drawn.add({0});     // 1, in the repeat 0
  drawn.add({1});     // 2, in the repeat 1, in the repeat 0
  drawn.add({0, 2});  // 3, in the repeat 0
  drawn.add({0});     // 4
  drawn.add({2, 4});  // 5
  Plan& plan = drawn.plan;
  plan.repeats.resize(2);
  plan.repeats[0].body = {{1, -1}, {-1, 1}, {3, -1}};
  plan.repeats[1].body = {{2, -1}};
  plan.order = {{0, -1}, {-1, 0}, {4, -1}, {5, -1}};
  const Depths depths = depths_of(plan);
  EXPECT_THAT(depths.steps, ElementsAre(1, 1, 1, 3, 2, 3));
  EXPECT_THAT(depths.repeats, ElementsAre(2, 2));
}

TEST(Level, WaitsForWhatItDrawsOnAndForWhatMayGiveTheSame) {
  DrawnPlan drawn;
  drawn.add({});      // 0
  drawn.add({0});     // 1
  drawn.add({0});     // 2, in the repeat 0
  drawn.add({1});     // 3
  drawn.add({0, 3});  // 4
  Plan& plan = drawn.plan;
  plan.repeats.resize(1);
  plan.repeats[0].body = {{2, -1}};
  plan.order = {{0, -1}, {1, -1}, {-1, 0}, {3, -1}, {4, -1}};
  using Places = std::vector<std::vector<std::size_t>>;
  EXPECT_EQ(level_of(plan, plan.order).before, (Places{{}, {0}, {0}, {1}, {0, 3}}));
  EXPECT_EQ(level_of(plan, plan.order).after, (Places{{1, 2, 4}, {3}, {}, {4}, {}}));
  EXPECT_EQ(level_of(plan, plan.repeats[0].body).before, Places(1));
  drawn.make_alike(3, 2, 1);  // by the one in the repeat
  EXPECT_EQ(level_of(plan, plan.order).before, (Places{{}, {0}, {0}, {1, 2}, {0, 3}}));
  drawn.make_alike(3, 2, 5);
  EXPECT_EQ(level_of(plan, plan.order).before, (Places{{}, {0}, {0}, {1}, {0, 3}}));
  plan.steps[2].parameters[0].row = 0;  // what it is in which pass is not known
  EXPECT_EQ(level_of(plan, plan.order).before, (Places{{}, {0}, {0}, {1, 2}, {0, 3}}));
}

TEST_F(OfAPlan, WhoMayAskAStepAreItsTakersAndThoseOfWhatPassesOn) {
  const Plan plan = with("  first: {use: test.trim, from: merged}\n", "first",
                         "      trimmed: {use: test.trim, from: first}\n");
  const auto users = users_of(plan);
  const auto of = [&](const std::string& path) {
    for (std::size_t s = 0; s < plan.steps.size(); ++s)
      if (plan.steps[s].path == path) return users[s];
    return std::vector<std::size_t>();
  };
  // source, merged, first, edges, loop, out.
  EXPECT_THAT(of("source"), ElementsAre(0, 1, 2, 4));  // by merged, which passes through to first
  EXPECT_THAT(of("merged"), ElementsAre(1, 2));
  EXPECT_THAT(of("first"), ElementsAre(2, 3, 4));
  EXPECT_THAT(of("loop.near"), ElementsAre(4));
  EXPECT_THAT(of("loop.solved"), ElementsAre(4, 5));
}

}  // namespace
}  // namespace plumb
