#include "plumb/store/upkeep.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/store_testing.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

void fill(Store& store, std::uint64_t n) {
  for (std::uint64_t k = 0; k < n; ++k)
    store.put({k, 1}, small_result(static_cast<double>(k)), "a.step");
}

TEST(Upkeep, PruneKeepsWhatWasUsedLast) {
  const io::TestFolder folder;
  Store store(folder.path() / "store");
  fill(store, 10);
  usleep(3000);
  for (const std::uint64_t k : {3, 7}) ASSERT_TRUE(store.find({k, 1}));
  const std::size_t each = store.bytes_of({3, 1});
  const Pruned pruned = prune(store, {{}, 2 * each + each / 2});
  EXPECT_EQ(pruned.results, 8u);
  EXPECT_EQ(pruned.bytes, 8 * each);
  EXPECT_EQ(pruned.left, 2u);
  EXPECT_EQ(pruned.left_bytes, 2 * each);
  for (std::uint64_t k = 0; k < 10; ++k) EXPECT_EQ(store.contains({k, 1}), k == 3 || k == 7) << k;
}

TEST(Upkeep, PruneRemovesWhatWasNotUsedForSoLong) {
  const io::TestFolder folder;
  Store store(folder.path() / "store");
  fill(store, 4);
  EXPECT_EQ(prune(store, {std::chrono::hours(1), {}}).results, 0u);
  usleep(1'100'000);
  ASSERT_TRUE(store.contains({2, 1}));
  EXPECT_EQ(prune(store, {std::chrono::seconds(1), {}}).results, 3u);
  EXPECT_TRUE(store.find({2, 1}));
}

TEST(Upkeep, PruneTakesWhatDeadRunsLeftUnfinished) {
  const io::TestFolder folder;
  Store store(folder.path() / "store");
  for (const char* name : {"old", "young"}) folder.write(std::string("store/new/") + name, "half");
  fs::last_write_time(store.folder() / "new/old",
                      fs::file_time_type::clock::now() - std::chrono::hours(25));
  const Pruned pruned = prune(store, {std::chrono::hours(1), {}});
  EXPECT_EQ(pruned.unfinished, 1u);
  EXPECT_EQ(pruned.unfinished_bytes, 4u);
  EXPECT_FALSE(fs::exists(store.folder() / "new/old"));
  EXPECT_TRUE(fs::exists(store.folder() / "new/young"));
}

constexpr const char* unfinished[] = {"new/4f0c.17.1", "index.sum.4711", "plumb-store.12"};

void leave_unfinished(const io::TestFolder& folder) {
  for (const std::string name : unfinished) folder.write("store/" + name, "half");
}

TEST(Upkeep, WhoOpensAStoreAloneRemovesWhatKilledRunsHadNotWrittenToItsEnd) {
  const io::TestFolder folder;
  const fs::path place = folder.path() / "store";
  { const Store made(place); }
  leave_unfinished(folder);
  folder.write("store/plumb-store.txt", "no number");
  folder.write("store/jobs/4f0c/image", "a job of a cluster, which may go on");
  { const Store later(place); }
  for (const char* name : unfinished) EXPECT_TRUE(fs::exists(place / name)) << name;
  fs::remove_all(place / "jobs/4f0c");
  const Store alone(place);
  for (const char* name : unfinished) EXPECT_FALSE(fs::exists(place / name)) << name;
  EXPECT_TRUE(fs::exists(place / "plumb-store.txt"));
}

TEST(Upkeep, WhatAnotherRunWritesIsLeftToIt) {
  const io::TestFolder folder;
  const Store first(folder.path() / "store");
  leave_unfinished(folder);
  const Store second(folder.path() / "store");
  for (const char* name : unfinished) EXPECT_TRUE(fs::exists(first.folder() / name)) << name;
}

TEST(Upkeep, PruneLeavesWhatARunInProgressMadeOrUsed) {
  const io::TestFolder folder;
  const fs::path place = folder.path() / "store";
  {
    Store earlier(place);
    fill(earlier, 4);
  }
  Store pruning(place);
  {
    Store run(place);
    ASSERT_TRUE(run.find({1, 1}));
    ASSERT_TRUE(run.put({20, 1}, small_result(20), "a.step"));
    run.sync();
    const Pruned by_size = prune(pruning, {{}, 0});
    EXPECT_EQ(by_size.results, 3u);
    EXPECT_EQ(by_size.held, 2u);
    EXPECT_EQ(by_size.left, 2u);
    EXPECT_EQ(by_size.left_bytes, pruning.bytes_of({1, 1}) + pruning.bytes_of({20, 1}));
    EXPECT_TRUE(run.find({1, 1}));
    EXPECT_TRUE(run.find({20, 1}));
    EXPECT_EQ(prune(pruning, {std::chrono::milliseconds(-1000), {}}).held, 2u) << "all are older";
    EXPECT_EQ(prune(pruning, {std::chrono::hours(1), {}}).held, 0u) << "they may stay anyway";
  }
  const Pruned later = prune(pruning, {{}, 0});
  EXPECT_EQ(later.results, 2u);
  EXPECT_EQ(later.held, 0u);
  EXPECT_EQ(later.left, 0u);
}

TEST(Upkeep, PruneOfASizeRemovesWhatWasUsedLaterInsteadOfWhatIsHeld) {
  const io::TestFolder folder;
  const fs::path place = folder.path() / "store";
  {
    Store earlier(place);
    fill(earlier, 2);
  }
  Store run(place), pruning(place);
  ASSERT_TRUE(run.contains({0, 1}));
  usleep(3000);
  ASSERT_TRUE(pruning.find({1, 1}));
  const std::size_t each = pruning.bytes_of({1, 1});
  EXPECT_EQ(prune(pruning, {{}, each}).results, 1u);
  EXPECT_TRUE(fs::exists(blob_file(place, {0, 1})));
  EXPECT_FALSE(fs::exists(blob_file(place, {1, 1})));
}

TEST(Upkeep, APrunedResultIsMadeAgainByARunThatGoesOn) {
  const io::TestFolder folder;
  {
    Store earlier(folder.path() / "store");
    fill(earlier, 3);
  }
  Store run(folder.path() / "store"), pruning(folder.path() / "store");
  EXPECT_EQ(prune(pruning, {{}, 0}).results, 3u) << "the run has not asked for any yet";
  EXPECT_FALSE(run.find({1, 1}));
  EXPECT_EQ(run.damaged(), 0u);
  fill(run, 3);
  EXPECT_TRUE(pruning.find({1, 1}));
}

TEST(Upkeep, VerifyRemovesWhatIsDamagedAndNamesIt) {
  const io::TestFolder folder;
  Store store(folder.path() / "store");
  fill(store, 5);
  const Verified good = verify(store);
  EXPECT_TRUE(good.good(store));
  EXPECT_EQ(good.results, 5u);
  const Hash128 key{2, 1};
  const fs::path file = store.folder() / "blobs" / key.text().substr(0, 2) / key.text();
  io::flip_byte(file, fs::file_size(file) - 40);
  const Verified bad = verify(store);
  EXPECT_THAT(bad.damaged, ElementsAre(AllOf(HasSubstr("a.step"), HasSubstr(key.text()))));
  EXPECT_FALSE(bad.good(store));
  EXPECT_FALSE(fs::exists(file));
  EXPECT_TRUE(verify(store).good(store));
}

}  // namespace
}  // namespace plumb
