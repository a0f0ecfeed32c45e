#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <optional>

#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/index.hpp"
#include "plumb/store/size_bound.hpp"
#include "plumb/store/upkeep.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

/// A pair that fails while it is told to.
struct Flaky : toy::EdgeStep {
  static inline bool fails = false;
  struct In {
    toy::OverEdges edges;
    Ends<toy::Segment> segments;
  };
  struct Params {};
  struct Out {
    toy::Matches matches;
  };
  static void describe(Declaration<Flaky>& is) {
    is.name("test.flaky").version(1).summary("Pairs, or not.").source("");
    is.input("edges", &In::edges, "").input("segments", &In::segments, "");
    is.output("matches", &Out::matches, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    if (fails) throw Error("not today");
    (void)in;
    return {engine_test::noted(3, 4)};
  }
};

/// How many pairs all edges have.
struct CountPairs : WholeStep {
  struct In {
    Each<toy::Matches> matches;
  };
  struct Params {};
  struct Out {
    toy::Metrics metrics;
  };
  static void describe(Declaration<CountPairs>& is) {
    is.name("test.count").version(1).summary("Counts pairs.").source("");
    is.input("matches", &In::matches, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    double pairs = 0;
    for (std::size_t k = 0; k < in.matches.size(); ++k)
      pairs += static_cast<double>(in.matches.open(k)->weight.size());
    Out out;
    out.metrics.numbers = {{"pairs", pairs, ""}};
    return out;
  }
};

Registry with_flaky() {
  static const StepOf<Flaky> flaky;
  static const StepOf<CountPairs> count;
  Registry steps = engine_test::registry();
  steps.add(flaky);
  steps.add(count);
  return steps;
}

struct Recall : testing::Test {
  const Registry steps = with_flaky();
  const fs::path folder = fs::temp_directory_path() / ("plumb_recall_" + std::to_string(getpid()));
  Trimmed trimmed;  ///< by the last run
  ~Recall() override { fs::remove_all(folder); }

  Plan plan(std::string text = engine_test::halving_steps, const std::string& more = "") {
    text = "plumb: 1\n" + text +
           "  out: {use: test.write, from: {metrics: {loop: "
           "loop.solved.metrics}, poses: loop.solved.poses}}\n" +
           more;
    fs::create_directories(folder);
    const fs::path file = folder / "halving.yaml";
    std::ofstream(file) << text;
    return read_pipeline(file, {}, steps);
  }
  RunResult run(const Plan& plan, bool fresh = false,
                std::optional<std::uint64_t> bound = std::nullopt) {
    Store store(folder / "store");
    RunOptions options;
    options.store = &store;
    options.fresh = fresh;
    SizeBound size(&store, bound);
    options.store_bound = &size;
    Observers silent;
    engine_test::frames_opened = engine_test::pairs_made = engine_test::shifted_made = 0;
    RunResult result = run_plan(plan, steps, options, silent);
    size.at_end();
    trimmed = size.trimmed();
    return result;
  }
  /// What the steps whose results are not files gave is gone from the store.
  void remove_all_but(const std::string& step) {
    Store store(folder / "store");
    for (const IndexRow& row : store.index()->rows())
      if (row.step != step) {
        EXPECT_TRUE(fs::remove(blob_file(folder / "store", row.key)));
      }
  }
  std::size_t results_in_store() {
    Store store(folder / "store");
    return store.index()->rows().size();
  }
  static std::string text_of(const RunResult& result) {
    std::string text;
    for (const auto& made : result.documents) text += made.document->bytes.text();
    return text;
  }
  static std::map<std::string, std::uint64_t> counts_of(const RunResult& result) {
    std::map<std::string, std::uint64_t> all;
    for (const StepCount& count : result.counts) all[count.path + ": " + count.what] = count.n;
    return all;
  }
  static std::vector<std::string> made_by(const RunResult& result) {
    std::vector<std::string> made;
    for (const Explained& one : result.explained)
      if (one.made > 0) made.push_back(one.path);
    return made;
  }
};

TEST_F(Recall, NothingButTheDocumentsHasToBeThere) {
  const Plan halving = plan();
  const RunResult first = run(halving);
  remove_all_but("test.write");
  const RunResult second = run(halving);
  EXPECT_EQ(text_of(second), text_of(first));
  EXPECT_EQ(counts_of(second), counts_of(first));
  EXPECT_FALSE(counts_of(second).empty());
  EXPECT_EQ(engine_test::frames_opened, 0);
  EXPECT_EQ(engine_test::pairs_made + engine_test::shifted_made, 0);
  EXPECT_THAT(made_by(second), testing::ElementsAre("source"));
  ASSERT_EQ(second.numbers.size(), first.numbers.size());
  for (std::size_t k = 0; k < first.numbers.size(); ++k)
    EXPECT_EQ(second.numbers[k].value.hash(), first.numbers[k].value.hash());
  ASSERT_EQ(second.loops.size(), 1u);
  EXPECT_EQ(second.loops[0].passes, first.loops[0].passes);
  EXPECT_EQ(second.loops[0].why, first.loops[0].why);
}

TEST_F(Recall, IsBookedAsAnEarlierRunsAndNotWhatTheRunItselfHadMade) {
  const RunResult first = run(plan()), second = run(plan());
  std::map<std::string, std::size_t> made;
  std::size_t remembered = 0, earlier = 0;
  for (const StepTime& time : first.times) {
    made[time.path] = time.items;
    remembered += time.remembered;  // pairs do not see poses: made in the first pass for all
    EXPECT_EQ(time.earlier, 0u) << time.path;
  }
  EXPECT_GT(remembered, 0u);
  for (const StepTime& time : second.times) {
    earlier += time.earlier;
    EXPECT_EQ(time.earlier, made[time.path] - time.items) << time.path;
  }
  EXPECT_GT(earlier, 0u);
}

TEST_F(Recall, WhatSomebodyAsksForAndIsGoneIsMadeAgain) {
  const std::string more =
      "  again: {use: test.write, from: {metrics: loop.solved.metrics}, with: {name: b.txt}}\n"
      "  joined: {use: test.chain, from: merged}\n"
      "  first: {use: test.pair, from: {edges: joined, segments: merged}}\n"
      "  gaps: {use: test.shift, from: {matches: first, poses: source.poses}}\n"
      "  end: {use: test.halve, from: {matches: gaps, poses: source.poses}}\n";
  const RunResult whole = run(plan(engine_test::halving_steps, more), true);
  fs::remove_all(folder / "store");
  run(plan());
  remove_all_but("test.write");
  const RunResult mended = run(plan(engine_test::halving_steps, more));
  EXPECT_EQ(text_of(mended), text_of(whole));
  EXPECT_GT(engine_test::frames_opened, 0);
}

TEST_F(Recall, AChangeIsMadeWithAllThatFollows) {
  run(plan());
  std::string changed = engine_test::halving_steps;
  changed.replace(changed.find("2 m, 1 m"), 8, "2 m, 3 m");
  const RunResult second = run(plan(changed));
  EXPECT_THAT(made_by(second), testing::ElementsAre("source", "loop.near", "loop.solved", "out"));
  EXPECT_EQ(engine_test::shifted_made, 3);  // of the last pass alone
  for (const Explained& one : second.explained)
    if (one.path == "loop.near" && one.pass == 2) {
      EXPECT_THAT(one.text(), HasSubstr("gate was 1 m, is 3 m"));
    }
  const RunResult third = run(plan(changed), true);
  EXPECT_EQ(text_of(second), text_of(third));
}

TEST_F(Recall, WhatFollowsFromADroppedItemIsMadeAnewWhenItComes) {
  const std::string more =
      "  tried: {use: test.flaky, from: {edges: edges, segments: merged}, on_error: drop}\n"
      "  found: {use: test.count, from: tried}\n"
      "  told: {use: test.write, from: {metrics: found}, with: {name: found.txt}}\n";
  Flaky::fails = true;
  const RunResult first = run(plan(engine_test::halving_steps, more));
  Flaky::fails = false;
  const RunResult second = run(plan(engine_test::halving_steps, more));
  const RunResult fresh = run(plan(engine_test::halving_steps, more), true);
  EXPECT_EQ(text_of(second), text_of(fresh));
  EXPECT_NE(text_of(second), text_of(first));
}

TEST_F(Recall, IsNotAskedByARunThatRefreshes) {
  run(plan());
  run(plan(), true);
  EXPECT_EQ(engine_test::pairs_made, 3);
  EXPECT_GT(engine_test::frames_opened, 0);
}

TEST_F(Recall, AKeyThatLeadsToSomethingElseIsNotBelieved) {
  const RunResult first = run(plan());
  {
    Store store(folder / "store");
    const auto rows = store.index()->rows();
    const auto file_of = [&](const std::string& step) {
      for (const IndexRow& row : rows)
        if (row.step == step) return blob_file(folder / "store", row.key);
      return fs::path();
    };
    fs::copy_file(file_of("test.chain"), file_of("test.write"),
                  fs::copy_options::overwrite_existing);
  }
  EXPECT_EQ(text_of(run(plan())), text_of(first));
}

TEST_F(Recall, NothingThatARunRecalledIsRemovedForABound) {
  const RunResult first = run(plan());
  EXPECT_EQ(trimmed.results, 0u);
  const std::size_t results = results_in_store();
  for (int again = 0; again < 2; ++again) {
    const RunResult bounded = run(plan(), false, 0);
    EXPECT_EQ(trimmed.results, 0u);
    EXPECT_GT(trimmed.own_bytes, 0u);
    EXPECT_EQ(trimmed.own_bytes, trimmed.left_bytes);
    EXPECT_EQ(results_in_store(), results);
    EXPECT_EQ(text_of(bounded), text_of(first));
    EXPECT_EQ(counts_of(bounded), counts_of(first));
    EXPECT_THAT(made_by(bounded), testing::ElementsAre("source"));
  }
}

TEST_F(Recall, WhatOnlyEarlierRunsUsedIsRemovedForABoundAndMadeAgain) {
  const RunResult first = run(plan());
  const std::size_t results = results_in_store();
  std::string changed = engine_test::halving_steps;
  changed.replace(changed.find("2 m, 1 m"), 8, "2 m, 3 m");
  const RunResult second = run(plan(changed), false, 1);
  EXPECT_GT(trimmed.results, 0u);
  EXPECT_LT(trimmed.results, results);
  EXPECT_EQ(text_of(run(plan(changed))), text_of(second));
  EXPECT_EQ(engine_test::shifted_made, 0) << "nothing of the bounded run is gone";
  EXPECT_EQ(text_of(run(plan())), text_of(first));
  EXPECT_GT(engine_test::shifted_made, 0);
}

TEST_F(Recall, ARunThatIsBoundedFromTheBeginningIsWhole) {
  const RunResult bounded = run(plan(), false, 0);
  EXPECT_EQ(trimmed.results, 0u);
  EXPECT_EQ(trimmed.own_bytes, trimmed.left_bytes);
  EXPECT_EQ(text_of(run(plan(), true)), text_of(bounded));
}

TEST_F(Recall, ResultsThatAreRecalledAreNotPrunedAsUnused) {
  run(plan());
  Store store(folder / "store");
  const auto before = store.index()->rows().size();
  PruneLimits limits;
  limits.older = std::chrono::hours(1);
  prune(store, limits);
  EXPECT_EQ(store.index()->rows().size(), before);
  limits.older = std::chrono::milliseconds(-1000);  // all
  prune(store, limits);
  EXPECT_THAT(store.index()->rows(), IsEmpty());
}

}  // namespace
}  // namespace plumb
