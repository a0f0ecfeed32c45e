#include <gmock/gmock.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "plumb/data/error.hpp"
#include "plumb/engine/observe/event_file.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using Kind = Event::Kind;

const std::string loop = "plumb: 1\nname: loop\n" + engine_test::halving_steps +
                         "  out: {use: test.write, from: {metrics: loop.solved.metrics}}\n";

/// An event with texts of its own.
struct Told {
  Event event;
  std::string step, item, sentence;
};

class Listener final : public Observer {
 public:
  void event(const Event& event) override {
    const std::lock_guard lock(mutex_);
    told.push_back(
        {event, std::string(event.step), std::string(event.item), std::string(event.sentence)});
  }
  std::vector<const Told*> of(Kind kind, const std::string& step = "") const {
    std::vector<const Told*> found;
    for (const Told& one : told)
      if (one.event.kind == kind && (step.empty() || one.step == step)) found.push_back(&one);
    return found;
  }
  std::vector<Told> told;

 private:
  std::mutex mutex_;
};

struct Events : testing::Test {
  Registry steps = engine_test::registry();
  fs::path folder = fs::temp_directory_path() / ("plumb_events_" + std::to_string(getpid()));
  Listener heard;
  Events() { fs::create_directories(folder); }
  ~Events() override { fs::remove_all(folder); }

  RunResult run(Observer& observer, const std::string& yaml = loop,
                std::vector<std::string> sets = {}) {
    std::ofstream(folder / "loop.yaml") << yaml;
    Overlay overlay;
    overlay.sets = std::move(sets);
    const Plan plan = read_pipeline(folder / "loop.yaml", overlay, steps);
    RunOptions options;
    options.threads = 2;
    return run_plan(plan, steps, options, observer);
  }
  std::string text(const char* name) const {
    std::ifstream in(folder / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Events, BeginAndEndTheRunAndEachPassOfAStep) {
  run(heard);
  EXPECT_EQ(heard.told.front().event.kind, Kind::run_begins);
  EXPECT_EQ(heard.told.front().sentence, "loop");
  EXPECT_EQ(heard.told.back().event.kind, Kind::run_ends);
  EXPECT_EQ(heard.told.back().sentence, "");
  EXPECT_EQ(heard.of(Kind::pass_begins, "loop").size(), 3u);
  std::string open;  // no step that is kept runs inside of another
  for (const Told& one : heard.told) {
    if (one.event.kind == Kind::step_begins) {
      EXPECT_EQ(open, "");
      open = one.step;
    } else if (one.event.kind == Kind::step_ends) {
      EXPECT_EQ(open, one.step);
      open.clear();
    } else if (one.event.kind == Kind::item) {
      EXPECT_NE(open, "") << one.step;
    }
  }
  const auto near = heard.of(Kind::step_ends, "loop.near");
  ASSERT_EQ(near.size(), 3u);
  for (int pass = 0; pass < 3; ++pass) {
    EXPECT_EQ(near[pass]->event.pass, pass);
    EXPECT_EQ(near[pass]->event.items, 3u);
  }
}

TEST_F(Events, TellOfEachItemAsTheTableCountsThem) {
  const RunResult result = run(heard);
  ASSERT_FALSE(result.times.empty());
  for (const StepTime& time : result.times) {
    std::size_t made = 0, reused = 0;
    for (const Told* one : heard.of(Kind::item, time.path)) ++(one->event.reused ? reused : made);
    EXPECT_EQ(made, time.items) << time.path;
    EXPECT_EQ(reused, time.remembered) << time.path;
  }
}

TEST_F(Events, SayWhatIsReusedInLaterPassesAndWhatEachItemIsCalled) {
  run(heard);
  const auto pairs = heard.of(Kind::item, "loop.pairs");
  ASSERT_EQ(pairs.size(), 9u);  // they do not see poses
  for (const Told* one : pairs) {
    EXPECT_EQ(one->event.reused, one->event.pass > 0);
    EXPECT_THAT(one->item, testing::AnyOf("edge 0-1", "edge 1-2", "edge 2-3"));
    EXPECT_EQ(one->event.process, getpid());
    EXPECT_GE(one->event.time, 0);
  }
  EXPECT_EQ(heard.of(Kind::item, "edges").at(0)->item, "");
  EXPECT_EQ(heard.of(Kind::item, "edges").at(0)->event.pass, -1);
  EXPECT_EQ(heard.of(Kind::item, "kept").size(), 12u);  // inside of merged's
}

TEST_F(Events, EndARunThatFailsWithTheReason) {
  EXPECT_THROW(run(heard, loop, {"kept.refuse=4"}), Error);
  EXPECT_EQ(heard.told.back().event.kind, Kind::run_ends);
  EXPECT_THAT(heard.told.back().sentence, testing::HasSubstr("will not"));
}

TEST_F(Events, MakeATraceWithOneSpanAnItem) {
  {
    TraceFile trace(folder / "trace.json");
    Observers both({&heard, &trace});
    run(both);
  }
  ASSERT_TRUE(text("trace.json").starts_with(TraceFile::mark));
  const auto json = nlohmann::json::parse(text("trace.json"));
  std::size_t items = 0, named = 0;
  for (const auto& one : json.at("traceEvents")) {
    if (one.at("ph") == "M") named += one.at("name") == "thread_name";
    if (one.at("ph") != "X") continue;
    EXPECT_GE(one.at("ts").get<double>(), 0);
    EXPECT_GE(one.at("dur").get<double>(), 0);
    EXPECT_EQ(one.at("pid"), getpid());
    if (one.at("cat") != "item") continue;
    ++items;
    EXPECT_TRUE(one.at("args").contains("item") && one.at("args").contains("reused") &&
                one.at("args").contains("step"));
  }
  EXPECT_EQ(items, heard.of(Kind::item).size());
  EXPECT_GE(named, 2u);  // steps, and a worker or two
}

TEST_F(Events, OfStepsBesideEachOtherLieOnTracksOfTheirOwn) {
  {
    TraceFile trace(folder / "trace.json");
    const auto ends = [&](const char* step, double begin, double end) {
      Event event;
      event.kind = Kind::step_ends;
      event.step = step;
      event.time = begin, event.duration = end - begin;
      event.process = getpid();
      trace.event(event);
    };
    ends("a", 0, 1);
    ends("b", 1, 3);
    ends("beside b", 0.5, 4);
    ends("beside both", 2, 5);
    ends("c", 3, 6);
    ends("after b", 4, 7);
  }
  const auto json = nlohmann::json::parse(text("trace.json"));
  std::map<std::string, int> track;
  std::set<std::string> names;
  for (const auto& one : json.at("traceEvents")) {
    const auto name = one.at("name").get<std::string>();
    if (one.at("ph") == "X") track[name] = one.at("tid").get<int>();
    if (name == "thread_name") names.insert(one.at("args").at("name").get<std::string>());
  }
  EXPECT_EQ(track["a"], track["b"]);
  EXPECT_EQ(track["a"], track["c"]);
  EXPECT_EQ(track["beside b"], track["after b"]);
  EXPECT_NE(track["a"], track["beside b"]);
  EXPECT_NE(track["a"], track["beside both"]);
  EXPECT_NE(track["beside b"], track["beside both"]);
  EXPECT_THAT(names, testing::ElementsAre("steps", "steps 2", "steps 3"));
}

TEST_F(Events, WriteAnObjectALineAtOnce) {
  EventLines lines(folder / "events.jsonl");
  Observers both({&heard, &lines});
  run(both);
  ASSERT_TRUE(text("events.jsonl").starts_with(EventLines::mark));  // the file is still open
  std::istringstream in(text("events.jsonl"));
  std::size_t n = 0;
  for (std::string line; std::getline(in, line); ++n)
    EXPECT_TRUE(nlohmann::json::parse(line).contains("event"));
  EXPECT_EQ(n, heard.told.size());
  EXPECT_EQ(lines.fault(), "");
}

TEST_F(Events, AFullDiskCostsTheFileAlone) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  EventLines lines("/dev/full");
  run(lines);
  EXPECT_THAT(lines.fault(), testing::HasSubstr("not whole"));
}

TEST(Bookkeeping, TakesItemsOfOtherProcesses) {
  Listener heard;
  Bookkeeping books(heard);
  const auto now = Bookkeeping::Clock::now();
  books.item({"far", "frame 3", 1, false, now, now + std::chrono::milliseconds(250), 0.2, 4711, 5});
  const Event& event = heard.told.at(0).event;
  EXPECT_EQ(event.process, 4711);
  EXPECT_EQ(event.worker, 5);
  EXPECT_NEAR(event.duration, 0.25, 1e-9);
  EXPECT_NEAR(books.times().at(0).cpu_seconds, 0.2, 1e-9);
}

TEST(Memory, SeesWhatAStepHeldAndLetGo) {
  constexpr std::size_t bytes = 200u << 20;
  MemoryWatch watch(std::chrono::milliseconds(5));
  const std::size_t before = watch.last();
  watch.begin("small");
  watch.end("small");
  watch.begin("large");
  {
    std::vector<char> held(bytes);
    std::memset(held.data(), 1, held.size());
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  const std::size_t large = watch.end("large");
  watch.begin("after");
  const std::size_t after = watch.end("after");
  EXPECT_GE(large, before + bytes * 95 / 100);
  EXPECT_LT(large, before + bytes * 2);
  EXPECT_LT(after, before + bytes / 2);
  EXPECT_EQ(watch.peak(), large);
}

TEST(Memory, AddsThatOfOtherProcesses) {
  EXPECT_GT(resident_bytes(getpid()), 0u);
  EXPECT_EQ(resident_bytes(-5), 0u);
  MemoryWatch watch(std::chrono::hours(1));
  watch.begin("alone");
  const std::size_t alone = watch.end("alone");
  watch.add_process(getppid());
  watch.begin("both");
  EXPECT_GT(watch.end("both"), alone);
  watch.remove_process(getppid());
  watch.begin("again");
  EXPECT_LT(watch.end("again"), watch.peak());
}

}  // namespace
}  // namespace plumb
