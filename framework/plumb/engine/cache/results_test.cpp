#include "plumb/engine/cache/results.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "plumb/engine/cache/explain.hpp"
#include "plumb/engine/run/admission.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

StoredResult numbers(std::size_t n) {
  StoredResult result;
  result.outputs.push_back({any_value(toy::Features{std::vector<float>(n, 1.5f)})});
  return result;
}

struct WithStore : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("plumb_results_" + std::to_string(getpid()));
  ~WithStore() override { fs::remove_all(folder); }
};

TEST_F(WithStore, WhatLeftMemoryComesBack) {
  Store store(folder);
  Results results(&store, false, 10'000);
  for (std::uint64_t k = 0; k < 8; ++k) results.keep({1, k}, numbers(1000), "test.step");
  EXPECT_FALSE(results.remembered({1, 0}));
  const auto back = results.find({1, 0});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->outputs[0][0].as<toy::Features>()->values, std::vector<float>(1000, 1.5f));
  EXPECT_TRUE(results.in_store({1, 7}));
  EXPECT_GE(results.size_of({1, 0}), 4000u);
}

TEST_F(WithStore, FrugalHoldsWhatWasAskedForAlone) {
  Store store(folder);
  Results results(&store, false, 1 << 20, true);
  results.keep({1, 1}, numbers(3), "test.step");
  EXPECT_FALSE(results.remembered({1, 1}));
  EXPECT_TRUE(results.find({1, 1}));
  EXPECT_TRUE(results.remembered({1, 1}));
}

TEST_F(WithStore, FreshFindsOnlyWhatThisRunMade) {
  Store store(folder);
  Results(&store, false, 1 << 20).keep({1, 1}, numbers(3), "test.step");
  Results fresh(&store, true, 16);  // too little to remember anything
  EXPECT_FALSE(fresh.find({1, 1}));
  fresh.keep({1, 2}, numbers(3), "test.step");
  EXPECT_TRUE(fresh.find({1, 2}));
}

TEST_F(WithStore, ASecondRunOpensNoFrame) {
  const Registry steps = engine_test::registry();
  const fs::path file = folder.string() + ".yaml";
  std::ofstream(file) << "plumb: 1\nsteps:\n  source: {use: test.source}\n  kept: {use: test.keep, "
                         "from: source.frames}\n"
                         "  merged: {use: test.merge, from: {frames: kept, ranges: "
                         "source.ranges}}\n  edges: {use: test.chain, from: merged}\n"
                         "  pairs: {use: test.pair, from: {edges: edges, segments: merged}}\n"
                         "  near: {use: test.shift, from: {matches: pairs, poses: source.poses, "
                         "edges: edges}, with: {gate: 1 m}}\n"
                         "  solved: {use: test.halve, from: {matches: near, poses: source.poses}}\n"
                         "  out: {use: test.write, from: {metrics: {last: solved.metrics}}}\n";
  const Plan plan = read_pipeline(file, {}, steps);
  fs::remove(file);
  Observers silent;
  Store store(folder);
  RunOptions options;
  options.store = &store;
  for (const int opened : {12, 0}) {
    engine_test::frames_opened = 0;
    const RunResult result = run_plan(plan, steps, options, silent);
    EXPECT_EQ(engine_test::frames_opened, opened);
    const auto& merged = result.explained.at(2);
    EXPECT_EQ(merged.text(), opened ? "merged: made, all 4: this cache knows no earlier run of it"
                                    : "merged: reused, all 4");
  }
}

TEST(Admission, CallsWaitUntilThereIsRoomAndABigOneRunsAlone) {
  Admission admission(100);
  std::atomic<int> inside = 0, most = 0;
  const auto call = [&](std::size_t bytes, int alone) {
    for (int k = 0; k < 200; ++k) {
      const Admission::Ticket ticket(admission, bytes);
      const int now = ++inside;
      if (alone) {
        EXPECT_EQ(now, 1);
      }
      int before = most;
      while (now > before && !most.compare_exchange_weak(before, now)) {
      }
      std::this_thread::yield();
      --inside;
    }
  };
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) threads.emplace_back(call, 40, false);
  threads.emplace_back(call, 1000, true);
  threads.clear();
  EXPECT_LE(most, 2);
}

TEST(Explain, TellsTheFirstDifferenceWithBothValues) {
  const Facts before = {{"step", "prune.distance"}, {"max", "1 m"}, {"input 'matches'", "aa (x)"}};
  EXPECT_EQ(first_difference(before, before), "");
  EXPECT_EQ(
      first_difference(
          before, {{"step", "prune.distance"}, {"max", "0.8 m"}, {"input 'matches'", "bb (x)"}}),
      "max was 1 m, is 0.8 m");
  EXPECT_EQ(first_difference(before, {{"step", "prune.distance"}, {"max", "1 m"}}),
            "input 'matches' is gone, was aa (x)");
  EXPECT_EQ(first_difference(before, {{"step", "prune.distance"},
                                      {"least", "2"},
                                      {"max", "1 m"},
                                      {"input 'matches'", "aa (x)"}}),
            "least is new: 2");
}

TEST(Explain, SaysHowManyWereMade) {
  EXPECT_EQ((Explained{"a", -1, false, 0, 3, ""}).text(), "a: reused, all 3");
  EXPECT_EQ((Explained{"a", 1, false, 2, 3, "max was 1 m, is 2 m"}).text(),
            "a, pass 2: 2 of 5 made: max was 1 m, is 2 m");
  EXPECT_EQ((Explained{"a", -1, true, 0, 0, ""}).text(), "a: passes through");
}

}  // namespace
}  // namespace plumb
