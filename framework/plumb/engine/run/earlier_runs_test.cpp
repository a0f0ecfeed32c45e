/// What a run gives and counts is the same whatever earlier runs left in the cache, and whoever is
/// first.
#include <gmock/gmock.h>

#include <map>
#include <optional>
#include <set>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/meeting_steps.hpp"
#include "plumb/pipeline/reader.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/index.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::Pair;

/// A source that counts when it is read and whenever a frame is opened.
struct Counting : WholeStep {
  struct In {};
  struct Params {};
  struct Out {
    Lazy<toy::Frame> frames;
    toy::Poses poses;
  };
  static void describe(Declaration<Counting>& is) {
    is.name("test.counting").version(1).summary("Counts.").source("");
    is.output("frames", &Out::frames, "").output("poses", &Out::poses, "");
  }
  Out run(const In&, const Params&, Context& context) const {
    context.count("lines read", 5);
    Out out;
    for (std::uint64_t k = 0; k < 7; ++k) out.frames.keys.push_back({1, k});
    out.frames.open = [](std::size_t k, Context& opening) {
      opening.count("lines read", 1);
      opening.count("frames opened", 1);
      return toy::Frame{static_cast<std::uint32_t>(k), 1.0F};
    };
    out.poses.places = {1, 2};
    return out;
  }
};

/// How many points a segment has, one segment a call: segments that nobody else takes pass.
struct Measure : toy::SegmentStep {
  struct In {
    One<toy::Segment> segment;
  };
  struct Params {};
  struct Out {
    toy::Features features;
  };
  static void describe(Declaration<Measure>& is) {
    is.name("test.measure").version(1).summary("Measures.").source("");
    is.input("segment", &In::segment, "").output("features", &Out::features, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    return {toy::Features{{static_cast<float>(in.segment->points.size())}}};
  }
};

using Counts = std::map<std::string, std::uint64_t>;

Counts counts_of(const RunResult& result) {
  Counts all;
  for (const StepCount& count : result.counts) all[count.path + ": " + count.what] = count.n;
  return all;
}

std::string text_of(const RunResult& result) {
  std::string text;
  for (const auto& made : result.documents) text += made.document->bytes.text();
  return text;
}

struct EarlierRuns : testing::Test {
  const io::TestFolder folder;
  Registry steps = engine_test::meeting_registry();
  EarlierRuns() {
    static const StepOf<Counting> counting;
    static const StepOf<Measure> measure;
    steps.add(counting);
    steps.add(measure);
  }
  /// In a cache in the folder, or without one.
  RunResult run(const std::string& text, const std::string& cache = "cache", unsigned threads = 2,
                bool fresh = false) {
    const Plan plan = read_pipeline(
        folder.write("earlier.yaml", "plumb: 1\nname: earlier\nsteps:\n" + text), {}, steps);
    std::optional<Store> store;
    if (!cache.empty()) store.emplace(folder.path() / cache);
    Observers silent;
    RunOptions options;
    options.threads = threads;
    options.store = store ? &*store : nullptr;
    options.fresh = fresh;
    return run_plan(plan, steps, options, silent);
  }
  /// What the steps whose results are not files gave is gone from the cache.
  void remove_all_but_files() {
    Store store(folder.path() / "cache");
    for (const IndexRow& row : store.index()->rows())
      if (row.step != "test.write") {
        EXPECT_TRUE(fs::remove(blob_file(folder.path() / "cache", row.key)));
      }
  }
};

TEST_F(EarlierRuns, OpenedTheFramesOfASourceWhoseCountsAreSaidAgain) {
  const std::string text = R"(  source: {use: test.counting}
  sum: {use: test.sum, from: source.frames}
  out: {use: test.write, from: {metrics: {sum: sum}}}
)";
  for (int again = 0; again < 3; ++again)
    EXPECT_THAT(counts_of(run(text)),
                ElementsAre(Pair("source: frames opened", 7u), Pair("source: lines read", 12u)));
}

TEST_F(EarlierRuns, LeftAStepThatSeesTheSameInEachPassAndIsCountedOnce) {
  const std::string text = R"(  source: {use: test.source, with: {frames: 30}}
  loop:
    repeat: {at_most: 3, carry: {poses: gauged}}
    start: {poses: source.poses}
    steps:
      told: {use: test.tell, from: {range: source.ranges}, with: {name: told}}
      gauged: {use: test.gauge, from: {features: told, poses: poses}, with: {name: gauged}}
  out: {use: test.write, from: {metrics: {gauged: loop.gauged.metrics}}}
)";
  const auto expected = ElementsAre(Pair("loop.gauged: collections summed", 3u),
                                    Pair("loop.told: segments told of", 10u));
  EXPECT_THAT(counts_of(run(text, "")), expected);
  EXPECT_THAT(counts_of(run(text)), expected);
  EXPECT_THAT(counts_of(run(text)), expected);
  EXPECT_THAT(counts_of(run(text, "cache", 2, true)), expected);
  EXPECT_THAT(counts_of(run(text)), expected);
}

TEST_F(EarlierRuns, MadeWhatIsGoneAndMadeAgainWithoutBeingCountedAgain) {
  const std::string text = R"(  source: {use: test.source, with: {frames: 30}}
  told: {use: test.tell, from: {range: source.ranges}, with: {name: told}}
  a: {use: test.gauge, from: {features: told, poses: source.poses}, with: {name: a}}
  out: {use: test.write, from: {metrics: {a: a.metrics}}}
)";
  const std::string more =
      R"(  b: {use: test.gauge, from: {features: told, poses: source.poses}, with: {name: b}}
  c: {use: test.gauge, from: {features: told, poses: source.poses}, with: {name: c}}
  end: {use: test.write, from: {metrics: {b: b.metrics, c: c.metrics}}, with: {name: end.txt}}
)";
  run(text);
  remove_all_but_files();
  EXPECT_THAT(counts_of(run(text + more)),
              ElementsAre(Pair("a: collections summed", 1u), Pair("b: collections summed", 1u),
                          Pair("c: collections summed", 1u), Pair("told: segments told of", 10u)));
}

/// u is recalled; w, which sees the same as u, is not, since y has another name: it finds what u
/// has, which v may have opened by then or not.
TEST_F(EarlierRuns, LeftResultsThatOneStepRecallsAndAnotherFinds) {
  const auto text = [](const std::string& y, const std::string& v) {
    return R"(  source: {use: test.source, with: {frames: 30}}
  x: {use: test.meet, from: source.poses, with: {name: x}}
  y: {use: test.meet, from: source.poses, with: {name: )" +
           y + R"(}}
  u: {use: test.tell, from: {range: source.ranges, poses: x.poses}, with: {name: told}}
  w: {use: test.tell, from: {range: source.ranges, poses: y.poses}, with: {name: told}}
  v: {use: test.gauge, from: {features: u, poses: source.poses}, with: {name: )" +
           v + R"(}}
  z: {use: test.gauge, from: {features: w, poses: source.poses}, with: {name: z}}
  out: {use: test.write, from: {metrics: {v: v.metrics, z: z.metrics}}}
)";
  };
  const auto expected =
      ElementsAre(Pair("u: segments told of", 10u), Pair("v: collections summed", 1u),
                  Pair("z: collections summed", 1u));
  for (const unsigned threads : {1u, 2u, 8u}) {
    const std::string cache = "cache" + std::to_string(threads);
    EXPECT_THAT(counts_of(run(text("y", "v"), cache, threads)), expected);
    EXPECT_THAT(counts_of(run(text("later", "opens"), cache, threads)), expected);
  }
}

TEST_F(EarlierRuns, AndStepsWhoseFramesPassCountTheSameForAnyNumberOfThreads) {
  const std::string text = R"(  source: {use: test.source, with: {frames: 60}}
  kept: {use: test.keep, from: source.frames}
  sum: {use: test.sum, from: kept}
  kept_too: {use: test.keep, from: source.frames}
  sum_too: {use: test.sum, from: kept_too}
  out: {use: test.write, from: {metrics: {sum: sum, too: sum_too}}}
)";
  std::set<Counts> first, second;
  for (int again = 0; again < 10; ++again)
    for (const unsigned threads : {1u, 2u, 8u}) {
      const std::string cache = std::to_string(again) + "-" + std::to_string(threads);
      first.insert(counts_of(run(text, cache, threads)));
      second.insert(counts_of(run(text, cache, threads)));
    }
  EXPECT_EQ(first.size(), 1u);
  EXPECT_EQ(second.size(), 1u);
  EXPECT_EQ(first.begin()->at("kept: frames seen"), 60u);
}

TEST_F(EarlierRuns, InWhichSegmentsPassedLeaveNothingForOneThatKeepsThem) {
  const std::string text = R"(  source: {use: test.source}
  merged: {use: test.merge, from: {frames: source.frames, ranges: source.ranges}}
  measured: {use: test.measure, from: merged}
  gauged: {use: test.gauge, from: {features: measured, poses: source.poses}}
  out: {use: test.write, from: {metrics: {gauged: gauged.metrics}}}
)";
  const std::string more = R"(  edges: {use: test.chain, from: merged}
  pairs: {use: test.pair, from: {edges: edges, segments: merged}}
  near: {use: test.shift, from: {matches: pairs, poses: source.poses, edges: edges}, with: {gate: 1 m}}
  solved: {use: test.halve, from: {matches: near, poses: source.poses}}
  end: {use: test.write, from: {metrics: {solved: solved.metrics}}, with: {name: end.txt}}
)";
  const std::string expected = text_of(run(text + more, ""));
  EXPECT_THAT(expected, testing::HasSubstr("gap=72"));
  run(text);
  EXPECT_EQ(text_of(run(text + more)), expected);
  run(text);
  EXPECT_EQ(text_of(run(text + more)), expected);
}

}  // namespace
}  // namespace plumb
