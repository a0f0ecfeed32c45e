#include "plumb/store/holds.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "plumb/data/io/file_testing.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

constexpr Hash128 first{1, 1}, second{1, 2}, third{1, 3};

struct HoldsOfRuns : testing::Test {
  const io::TestFolder folder;
  const fs::path runs = folder.path() / "runs";
  HoldsOfRuns() { fs::create_directory(runs); }
};

TEST_F(HoldsOfRuns, AreSeenAsTheyAreAdded) {
  Holds run(folder.path(), "17");
  HeldElsewhere elsewhere(runs, runs / "18.0");
  EXPECT_FALSE(elsewhere.has(first));
  run.add({&first, 1});
  EXPECT_TRUE(run.has(first));
  EXPECT_TRUE(elsewhere.has(first));
  EXPECT_FALSE(run.has(second));
  EXPECT_FALSE(elsewhere.has(second));
  const Hash128 more[] = {first, second, second};
  run.add(more);
  EXPECT_TRUE(elsewhere.has(second));
  Holds later(folder.path(), "19");
  later.add({&third, 1});
  EXPECT_TRUE(elsewhere.has(third));
  EXPECT_EQ(fs::file_size(run.file()), 2 * sizeof(Hash128)) << "each key once";
}

TEST_F(HoldsOfRuns, AreNotAddedWhileWhatIsNotHeldIsRemoved) {
  Holds run(folder.path(), "17");
  run.add({&first, 1});
  EXPECT_FALSE(run.unless_held(first, [] { ADD_FAILURE() << "it is held"; }));
  std::thread other;
  bool added_before = true;
  EXPECT_TRUE(run.unless_held(second, [&] {
    other = std::thread([&] { run.add({&second, 1}); });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    added_before = fs::file_size(runs / "17.0") > sizeof(Hash128);
  }));
  other.join();
  EXPECT_FALSE(added_before);
  EXPECT_TRUE(run.has(second));
}

TEST_F(HoldsOfRuns, AreNoneOfOnesOwnAndNoneOfRunsThatEnded) {
  Holds run(folder.path(), "17");
  run.add({&first, 1});
  {
    Holds ended(folder.path(), "18");
    ended.add({&second, 1});
  }
  HeldElsewhere elsewhere(runs, run.file());
  EXPECT_FALSE(elsewhere.has(first));
  EXPECT_FALSE(elsewhere.has(second));
  EXPECT_TRUE(fs::exists(run.file()));
}

TEST_F(HoldsOfRuns, LeaveWhatIsNoFileOfThemAlone) {
  fs::create_directory(runs / "folder");
  fs::create_symlink(folder.write("theirs", "not to be touched"), runs / "link");
  Holds run(folder.path(), "17");
  run.add({&first, 1});
  HeldElsewhere elsewhere(runs, run.file());
  EXPECT_FALSE(elsewhere.has(second));
  EXPECT_TRUE(fs::exists(folder.path() / "theirs"));
  EXPECT_TRUE(fs::exists(runs / "folder"));
}

TEST_F(HoldsOfRuns, ThatCannotBeWrittenAreKnownToTheRunItself) {
  Holds run(folder.path() / "nowhere", "17");
  run.add({&first, 1});
  EXPECT_TRUE(run.has(first));
  EXPECT_FALSE(run.has(second));
  HeldElsewhere elsewhere(folder.path() / "nowhere/runs", {});
  EXPECT_TRUE(elsewhere.has(second)) << "nobody knows what others need";
}

TEST_F(HoldsOfRuns, AreAllThereWhenThreadsAddThem) {
  Holds run(folder.path(), "17");
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t)
    threads.emplace_back([&run, t] {
      for (std::uint64_t k = 0; k < 500; ++k) {
        const Hash128 key{t, k};
        run.add({&key, 1});
      }
    });
  for (std::thread& thread : threads) thread.join();
  HeldElsewhere elsewhere(runs, {});
  for (std::uint64_t t = 0; t < 4; ++t)
    for (std::uint64_t k = 0; k < 500; ++k) EXPECT_TRUE(elsewhere.has({t, k}));
  EXPECT_FALSE(elsewhere.has({4, 0}));
}

}  // namespace
}  // namespace plumb
