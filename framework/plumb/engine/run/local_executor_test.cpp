#include "plumb/engine/run/local_executor.hpp"

#include <gmock/gmock.h>

#include <atomic>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Ranges of which each comes twice, as far as `unlike` lets it.
struct Twice : WholeStep {
  struct In {};
  struct Params {
    int items = 6;
    bool unlike = false;
  };
  struct Out {
    std::vector<toy::FrameRange> ranges;
  };
  static void describe(Declaration<Twice>& is) {
    is.name("test.twice").version(1).summary("Gives ranges.").source("");
    is.param("items", &Params::items).range(1, 1000).doc("how many");
    is.param("unlike", &Params::unlike).doc("each once");
    is.output("ranges", &Out::ranges, "");
  }
  Out run(const In&, const Params& params, Context&) const {
    Out out;
    for (int k = 0; k < params.items; ++k) {
      const auto first = static_cast<std::uint32_t>(params.unlike ? k : k % (params.items / 2));
      out.ranges.push_back({first, first + 1});
    }
    return out;
  }
};

/// Numbers its calls, and refuses ranges from `refuse` on.
struct Once : toy::SegmentStep {
  static inline std::atomic<int> made{0};
  struct In {
    One<toy::FrameRange> range;
  };
  struct Params {
    int refuse = 1000;
  };
  struct Out {
    toy::Features features;
  };
  static void describe(Declaration<Once>& is) {
    is.name("test.once").version(1).summary("Counts calls.").source("");
    is.param("refuse", &Params::refuse).range(0, 1000).doc("the first that fails");
    is.input("range", &In::range, "").output("features", &Out::features, "");
  }
  Out run(const In& in, const Params& params, Context& context) const {
    ++made;
    context.count("ranges seen", 1);
    if (static_cast<int>(in.range->first) >= params.refuse) throw Error("will not");
    return {toy::Features{{static_cast<float>(in.range->first)}}};
  }
};

/// All features in a row.
struct List : WholeStep {
  struct In {
    Each<toy::Features> features;
  };
  struct Params {};
  struct Out {
    toy::Metrics metrics;
  };
  static void describe(Declaration<List>& is) {
    is.name("test.list").version(1).summary("Lists.").source("");
    is.input("features", &In::features, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In& in, const Params&, Context&) const {
    Out out;
    for (std::size_t k = 0; k < in.features.size(); ++k)
      out.metrics.add(std::to_string(k), in.features.open(k)->values.at(0), "");
    return out;
  }
};

struct CallsHere : testing::Test {
  const io::TestFolder folder;
  Registry steps = engine_test::registry();

  CallsHere() {
    static const StepOf<Twice> twice;
    static const StepOf<Once> once;
    static const StepOf<List> list;
    for (const Step* step : std::initializer_list<const Step*>{&twice, &once, &list})
      steps.add(*step);
    Once::made = 0;
  }
  RunResult run(const std::string& with, unsigned threads, Store* store = nullptr,
                const std::string& refuse = "1000") {
    const Plan plan = read_pipeline(
        folder.write("here.yaml", "plumb: 1\nname: here\nsteps:\n  twice: {use: test.twice" + with +
                                      "}\n  once: {use: test.once, from: twice, with: {refuse: " +
                                      refuse + "}}\n  list: {use: test.list, from: once}\n"),
        {}, steps);
    Observers silent;
    RunOptions options;
    options.threads = threads;
    options.store = store;
    return run_plan(plan, steps, options, silent);
  }
  /// Made, remembered.
  static std::pair<std::size_t, std::size_t> items(const RunResult& result) {
    for (const StepTime& time : result.times)
      if (time.path == "once") return {time.items, time.remembered};
    return {0, 0};
  }
  static std::vector<double> values(const RunResult& result) {
    std::vector<double> all;
    for (const Number& number : result.numbers.at(0).value.as<toy::Metrics>()->numbers)
      all.push_back(number.value);
    return all;
  }
};

TEST_F(CallsHere, OfItemsWithOneKeyAreMadeOnceAndAllHaveTheValue) {
  Store store(folder.path() / "store");
  for (Store* kept : {static_cast<Store*>(nullptr), &store})
    for (const unsigned threads : {1u, 2u}) {
      if (kept && threads == 2) continue;  // all would be there
      Once::made = 0;
      const RunResult result = run("", threads, kept);
      EXPECT_EQ(Once::made, 3);
      EXPECT_THAT(values(result), ElementsAre(0, 1, 2, 0, 1, 2));
      EXPECT_EQ(items(result), std::pair(std::size_t{3}, std::size_t{3}));
      ASSERT_EQ(result.counts.size(), 1u);
      EXPECT_EQ(result.counts[0].text(), "once: 3 ranges seen");
    }
}

TEST_F(CallsHere, ThatFailTakeThoseOfTheSameKeyWithThem) {
  EXPECT_EQ(io::refusal([&] { run("", 1, nullptr, "2"); }),
            "step 'once' (test.once), segment 2: will not; 1 further items of step 'once' failed: "
            "segment 5");
  EXPECT_EQ(Once::made, 3);
}

TEST_F(CallsHere, AreLeftOutWhenSoManyFailThatItIsNotTheItems) {
  const std::string said =
      io::refusal([&] { run(", with: {items: 100, unlike: true}", 1, nullptr, "4"); });
  EXPECT_THAT(said, HasSubstr("segment 4: will not; 15 or more further items"));
  EXPECT_EQ(Once::made, 20);
}

}  // namespace
}  // namespace plumb
