#include "plumb/store/size_bound.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/index.hpp"
#include "plumb/store/store_testing.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

/// A store with ten results of an earlier run, {0, 1} to {9, 1}, all of one size.
struct Bound : testing::Test {
  const io::TestFolder folder;
  const fs::path path = folder.path() / "store";
  std::uint64_t each = 0;

  Bound() {
    Store earlier(path);
    for (std::uint64_t k = 0; k < 10; ++k) make(earlier, k);
    each = earlier.bytes_of({0, 1});
  }
  static void make(Store& store, std::uint64_t k) {
    ASSERT_TRUE(store.put({k, 1}, small_result(static_cast<double>(k)), "a.step"));
  }
  /// Which of the first 40 are there, seen without a store.
  std::vector<std::uint64_t> there() const {
    std::vector<std::uint64_t> all;
    for (std::uint64_t k = 0; k < 40; ++k)
      if (fs::exists(blob_file(path, {k, 1}))) all.push_back(k);
    return all;
  }
  std::vector<fs::path> files_of_runs() const {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(path / "runs")) all.push_back(entry.path());
    return all;
  }
};

TEST_F(Bound, RemovesWhatWasUsedLeastRecentlyUntilItHolds) {
  usleep(3000);
  {
    Store later(path);
    for (const std::uint64_t k : {3, 7}) ASSERT_TRUE(later.find({k, 1}));
  }
  Store store(path);
  const Trimmed trimmed = trim(store, 2 * each + each / 2, 2 * each + each / 2);
  EXPECT_THAT(there(), ElementsAre(3, 7));
  EXPECT_EQ(trimmed.results, 8u);
  EXPECT_EQ(trimmed.bytes, 8 * each);
  EXPECT_EQ(trimmed.left_bytes, 2 * each);
  EXPECT_EQ(trimmed.own_bytes, 0u);
  EXPECT_EQ(store.index()->bytes(), 2 * each);
}

TEST_F(Bound, IsNotAskedForUntilThereIsSoMuchMore) {
  Store store(path);
  const Trimmed trimmed = trim(store, each, 10 * each);
  EXPECT_EQ(trimmed.results, 0u);
  EXPECT_EQ(trimmed.left_bytes, 10 * each);
  EXPECT_EQ(there().size(), 10u);
}

TEST_F(Bound, LeavesWhatTheRunMadeOrUsed) {
  Store run(path);
  ASSERT_TRUE(run.find({2, 1}));
  ASSERT_TRUE(run.contains({3, 1}));
  const Hash128 recalled[] = {{4, 1}, {5, 1}};
  run.hold(recalled);
  make(run, 20);
  run.note({6, 1}, "a.step");
  const Trimmed trimmed = trim(run, each, each);
  EXPECT_THAT(there(), ElementsAre(2, 3, 4, 5, 6, 20));
  EXPECT_EQ(trimmed.results, 5u);
  EXPECT_EQ(trimmed.left_bytes, 6 * each);
  EXPECT_EQ(trimmed.own_bytes, 6 * each);
}

TEST_F(Bound, LeavesWhatAnotherRunInProgressMadeOrUsed) {
  Store run(path);
  {
    Store other(path);
    ASSERT_TRUE(other.find({2, 1}));  // nothing of it is in the index yet
    const Hash128 recalled[] = {{4, 1}, {5, 1}};
    other.hold(recalled);
    make(other, 20);
    other.sync();
    make(other, 21);
    const Trimmed trimmed = trim(run, 0, 0);
    EXPECT_THAT(there(), ElementsAre(2, 4, 5, 20, 21));
    EXPECT_EQ(trimmed.results, 7u);
    EXPECT_EQ(trimmed.left_bytes, 4 * each);
    EXPECT_EQ(trimmed.own_bytes, 0u);
  }
  EXPECT_THAT(files_of_runs(), IsEmpty());
  trim(run, 0, 0);
  EXPECT_THAT(there(), IsEmpty());
}

TEST_F(Bound, DoesNotWaitForARunThatWasKilled) {
  const pid_t child = fork();
  if (child == 0) {
    Store killed(path);
    killed.find({2, 1});
    raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(files_of_runs().size(), 1u);
  Store run(path);
  EXPECT_EQ(trim(run, 0, 0).results, 10u);
  EXPECT_THAT(files_of_runs(), IsEmpty());
}

TEST_F(Bound, TakesAwayWhatKilledRunsLeftWhenTheFirstResultIsUsed) {
  folder.write("store/runs/4711.0", std::string(32, 'x'));
  Store run(path);
  ASSERT_TRUE(run.find({2, 1}));
  ASSERT_EQ(files_of_runs().size(), 1u);
  EXPECT_EQ(fs::file_size(files_of_runs()[0]), sizeof(Hash128));
}

/// As a full disk leaves it: the file does not hold whole keys.
TEST_F(Bound, RemovesNothingWhileARunCannotSayWhatItNeeds) {
  const fs::path file = folder.write("store/runs/4711.0", "x");
  const int other = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  Store run(path);
  EXPECT_EQ(trim(run, 0, 0).results, 0u);
  EXPECT_EQ(there().size(), 10u);
  ::close(other);
  EXPECT_EQ(trim(run, 0, 0).results, 10u);
}

TEST_F(Bound, IsHeldBetweenStepsWhenAQuarterMoreIsThereAndInTheEnd) {
  Store run(path);
  SizeBound bound(&run, 6 * each);
  bound.after_step();
  EXPECT_EQ(bound.trimmed().results, 0u) << "this run has kept nothing yet";
  make(run, 20);
  bound.after_step();
  EXPECT_EQ(bound.trimmed().results, 5u);
  EXPECT_EQ(bound.trimmed().left_bytes, 6 * each);
  make(run, 21);
  bound.after_step();
  EXPECT_EQ(bound.trimmed().results, 5u) << "seven are less than a quarter too much";
  bound.at_end();
  EXPECT_EQ(bound.trimmed().results, 6u);
  EXPECT_EQ(bound.trimmed().bytes, 6 * each);
  EXPECT_EQ(there().size(), 6u);
}

TEST_F(Bound, OfNoStoreAndNoBoundDoNothing) {
  Store run(path);
  for (SizeBound bound : {SizeBound(nullptr, 0), SizeBound(&run, std::nullopt)}) {
    bound.after_step(), bound.at_end();
    EXPECT_EQ(bound.trimmed().results, 0u);
  }
  EXPECT_EQ(there().size(), 10u);
}

TEST_F(Bound, ByDefaultIsNoMoreThanTheDiskCanGive) {
  Store store(path);
  const std::uint64_t bound = default_bound(store);
  EXPECT_GT(bound, 0u);
  EXPECT_LE(bound, default_store_size);
  EXPECT_LE(bound, fs::space(path).capacity / 5 * 4 + 10 * each);
}

}  // namespace
}  // namespace plumb
