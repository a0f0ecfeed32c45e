#include "plumb/engine/run/schedule.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <string>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/engine/testing/drawn_plan.hpp"

namespace plumb {
namespace {

using engine_test::DrawnPlan;
using testing::ElementsAre;
using testing::ElementsAreArray;

/// Notes what it is told, in order, and lets a step do what a test wants.
class Noted final : public Work {
 public:
  void run_step(int step, const Turn& turn) override {
    note("step " + std::to_string(step));
    const std::lock_guard lock(mutex_);
    turns.push_back(turn);
    if (failing.contains(step)) throw Error("step " + std::to_string(step));
    if (leaving.contains(step)) throw LeftOut();
  }
  void begin_repeat(int repeat) override { note("repeat " + std::to_string(repeat)); }
  void begin_pass(int repeat, int pass) override {
    note("pass " + std::to_string(pass) + " of " + std::to_string(repeat));
  }
  bool end_pass(int repeat, const Turn& turn) override {
    const std::lock_guard lock(mutex_);
    ends.push_back(turn);
    return static_cast<int>(turn.back()) < passes.at(repeat);
  }
  void item_done(std::size_t place) override { note("done " + std::to_string(place)); }

  std::map<int, int> passes;  ///< by repeat
  std::set<int> failing, leaving;
  std::vector<std::string> told;
  std::vector<Turn> turns, ends;

 private:
  void note(const std::string& what) {
    const std::lock_guard lock(mutex_);
    told.push_back(what);
  }
  std::mutex mutex_;
};

/// 0, then a repeat of 1 and 2, in which 2 lies in a repeat of its own, then 3, which waits for 0
/// alone.
struct Nested : testing::Test {
  DrawnPlan drawn;
  Noted noted;
  Nested() {
    drawn.add({});
    drawn.add({0});
    drawn.add({1});
    drawn.add({0});
    drawn.plan.repeats.resize(2);
    drawn.plan.repeats[0].body = {{1, -1}, {-1, 1}};
    drawn.plan.repeats[1].body = {{2, -1}};
    drawn.plan.order = {{0, -1}, {-1, 0}, {3, -1}};
    noted.passes = {{0, 2}, {1, 2}};
  }
};

TEST_F(Nested, OneThreadRunsThePlanInItsOrder) {
  const std::vector<std::string> expected = {
      "step 0", "done 0",      "repeat 0", "pass 0 of 0", "step 1", "repeat 1", "pass 0 of 1",
      "step 2", "pass 1 of 1", "step 2",   "pass 1 of 0", "step 1", "repeat 1", "pass 0 of 1",
      "step 2", "pass 1 of 1", "step 2",   "done 1",      "step 3", "done 2"};
  Schedule(drawn.plan, noted).run(false);
  EXPECT_THAT(noted.told, ElementsAreArray(expected));
  noted.told.clear();
  with_threads(1, [&] { Schedule(drawn.plan, noted).run(true); });
  EXPECT_THAT(noted.told, ElementsAreArray(expected));
}

TEST_F(Nested, TurnsAreInTheOrderOfOneThread) {
  Schedule(drawn.plan, noted).run(false);
  EXPECT_TRUE(std::is_sorted(noted.turns.begin(), noted.turns.end()));
  EXPECT_THAT(noted.turns.at(3), ElementsAre(1, 0, 1, 1, 0));  // 2, in the second pass of the first
  EXPECT_TRUE(std::is_sorted(noted.ends.begin(), noted.ends.end()));
  EXPECT_THAT(noted.ends.front(), ElementsAre(1, 0, 1, 1));
  EXPECT_THAT(noted.ends.back(), ElementsAre(1, 2));
}

TEST_F(Nested, AfterAFailureNothingBegins) {
  noted.failing = {2};
  EXPECT_EQ(io::refusal([&] { Schedule(drawn.plan, noted).run(false); }), "step 2");
  EXPECT_EQ(noted.told.back(), "step 2");
  EXPECT_EQ(noted.turns.size(), 3u);
}

TEST_F(Nested, CallsThatAreLeftOutForNoReasonAreAFailureToo) {
  for (const int step : {0, 2, 3}) {
    noted.leaving = {step};
    EXPECT_THAT(io::refusal([&] { Schedule(drawn.plan, noted).run(false); }),
                testing::HasSubstr("left calls out"));
    EXPECT_THAT(
        io::refusal([&] { with_threads(2, [&] { Schedule(drawn.plan, noted).run(true); }); }),
        testing::HasSubstr("left calls out"));
  }
}

TEST_F(Nested, ABodyOfNothingHasItsPassesToo) {
  drawn.plan.repeats[1].body.clear();
  Schedule(drawn.plan, noted).run(false);
  EXPECT_EQ(noted.ends.size(), 6u);
  EXPECT_EQ(noted.told.back(), "done 2");
}

/// In what order steps began and ended.
class Timed final : public Work {
 public:
  explicit Timed(std::size_t steps) : began(steps, 0), ended(steps, 0) {}
  void run_step(int step, const Turn&) override {
    began[step] = ++clock_;
    ended[step] = ++clock_;
  }
  void begin_repeat(int) override {}
  void begin_pass(int, int) override {}
  bool end_pass(int, const Turn&) override { return false; }
  void item_done(std::size_t) override { ++done; }
  std::vector<int> began, ended;
  std::atomic<std::size_t> done{0};

 private:
  std::atomic<int> clock_{0};
};

TEST(Schedule, RunsEachItemOnceAfterAllThatItWaitsFor) {
  std::mt19937 random(7);
  for (int plans = 0; plans < 200; ++plans) {
    DrawnPlan drawn;
    std::vector<std::vector<int>> from(25);
    for (int s = 0; s < 25; ++s) {
      for (int earlier = 0; earlier < s; ++earlier)
        if (random() % 6 == 0) from[s].push_back(earlier);
      drawn.add(from[s]);
      drawn.plan.order.push_back({s, -1});
    }
    Timed timed(25);
    with_threads(8, [&] { Schedule(drawn.plan, timed).run(true); });
    ASSERT_EQ(timed.done, 25u);
    for (int s = 0; s < 25; ++s)
      for (const int earlier : from[s]) ASSERT_LT(timed.ended[earlier], timed.began[s]);
  }
}

}  // namespace
}  // namespace plumb
