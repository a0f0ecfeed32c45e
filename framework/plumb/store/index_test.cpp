#include "plumb/store/index.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <sstream>
#include <thread>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/store/database.hpp"
#include "plumb/store/store_testing.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::uint64_t few = 30;

/// A store of a few results with facts and hashes of files, closed.
fs::path filled(const io::TestFolder& folder) {
  const fs::path path = folder.path() / "store";
  Store store(path);
  for (std::uint64_t k = 0; k < few; ++k)
    store.put({k, 7 * k}, small_result(static_cast<double>(k)), k % 2 ? "odd.step" : "even.step");
  for (int pass = 0; pass < 5; ++pass)
    store.index()->set_facts("cascade", "coarse.matches", pass,
                             {{"version", "2"}, {"gate", std::to_string(pass)}});
  store.index()->set_file_hash("/data/a.pcd", 123, 456, {8, 9});
  return path;
}

std::string bytes_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void put_back(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// All results are found by key and listed.
void expect_whole(Store& store) {
  for (std::uint64_t k = 0; k < few; ++k) {
    const auto found = store.find({k, 7 * k});
    ASSERT_TRUE(found);
    EXPECT_EQ(x_of(*found), static_cast<double>(k));
  }
  const auto rows = store.index()->rows();
  ASSERT_EQ(rows.size(), few);
  std::uint64_t bytes = 0;
  for (const IndexRow& row : rows) bytes += row.bytes;
  EXPECT_EQ(store.index()->bytes(), bytes);
  for (const IndexRow& row : rows) {
    EXPECT_EQ(row.step, row.key.high % 2 ? "odd.step" : "even.step");
    EXPECT_EQ(row.bytes, store.bytes_of(row.key));
  }
}

/// What happens in a process of its own; how it ended.
template <class Action>
int in_another_process(Action action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(Index, KeepsResultsFactsAndHashesOfFiles) {
  const io::TestFolder folder;
  const fs::path path = filled(folder);
  EXPECT_TRUE(fs::exists(path / "index.sum"));
  EXPECT_FALSE(fs::exists(path / "index.sqlite-wal"));
  Store store(path);
  EXPECT_FALSE(fs::exists(path / "index.sum"));
  EXPECT_EQ(store.index_rebuilt(), "");
  expect_whole(store);
  EXPECT_EQ(store.index()->facts("cascade", "coarse.matches", 3),
            (std::vector<Fact>{{"version", "2"}, {"gate", "3"}}));
  EXPECT_TRUE(store.index()->facts("cascade", "coarse.matches", 9).empty());
  EXPECT_EQ(store.index()->file_hash("/data/a.pcd", 123, 456), (Hash128{8, 9}));
  EXPECT_FALSE(store.index()->file_hash("/data/a.pcd", 123, 457));
  EXPECT_EQ(store.index_rebuilt() + store.index_fault(), "");
}

TEST(Index, ListsWhatWasUsedLastInTheEnd) {
  const io::TestFolder folder;
  const fs::path path = filled(folder);
  usleep(3000);
  { Store(path).find({4, 28}); }
  usleep(3000);
  Store store(path);
  EXPECT_TRUE(store.contains({2, 14}));
  const auto rows = store.index()->rows();
  ASSERT_EQ(rows.size(), few);
  EXPECT_EQ(rows[few - 1].key, (Hash128{2, 14}));
  EXPECT_EQ(rows[few - 2].key, (Hash128{4, 28}));
  EXPECT_LT(rows[few - 1].made, rows[few - 1].used);
}

/// A step with results of its own and one whose values pass through, recalled in one run.
TEST(Index, KnowsRecalledStepsAsLongAsResultsOfTheirTimeAreLeft) {
  const io::TestFolder folder;
  Store store(filled(folder));
  usleep(3000);
  Index& index = *store.index();
  const Hash128 with_results{1000, 1}, passing{1000, 2}, without{1000, 3};
  Recalled recalled;
  recalled.counts = {{"points dropped", 3}};
  index.set_recalled(passing, recalled);
  recalled.items = {{4, 28}, {5, 35}};
  index.set_recalled(with_results, recalled);
  recalled.items = {{4, 29}};
  index.set_recalled(without, recalled);
  index.settle_recalled(0);
  EXPECT_TRUE(index.recalled(with_results));
  ASSERT_TRUE(index.recalled(passing));
  EXPECT_EQ(index.recalled(passing)->counts.at(0).n, 3u);
  EXPECT_FALSE(index.recalled(without)) << "none of its results is left";
  const auto rows = index.rows();
  EXPECT_THAT((std::vector{rows[few - 2].key, rows[few - 1].key}),
              testing::UnorderedElementsAre(Hash128{4, 28}, Hash128{5, 35}))
      << "their recall is their last use";
  for (const IndexRow& row : rows) store.remove(row.key);
  index.settle_recalled(0);
  EXPECT_FALSE(index.recalled(with_results));
  EXPECT_FALSE(index.recalled(passing));
}

TEST(Index, KnowsWhatAnotherThreadIsWriting) {
  const io::TestFolder folder;
  Store store(filled(folder));
  Index& index = *store.index();
  std::atomic<bool> over = false;
  {
    const std::jthread writer([&] {
      while (!over) index.flush();
    });
    for (std::uint64_t k = 0; k < 1000 && !over; ++k) {
      const std::vector<Fact> facts = {{"gate", std::to_string(k)}};
      index.set_facts("cascade", "coarse.matches", 0, facts);
      index.set_recalled({2000, k}, {});
      for (int again = 0; again < 3 && !over; ++again) {
        const bool known = index.facts("cascade", "coarse.matches", 0) == facts &&
                           index.recalled({2000, k}).has_value();
        EXPECT_TRUE(known) << k;
        over = !known;
      }
    }
    over = true;
  }
  EXPECT_EQ(store.index_fault(), "");
}

TEST(Index, NoticesEachByteThatChangedAndIsMadeAnew) {
  const io::TestFolder folder;
  const fs::path path = filled(folder), index = path / "index.sqlite", sum = path / "index.sum";
  const std::string bytes = bytes_of(index), checksum = bytes_of(sum);
  constexpr std::size_t positions = 60;
  for (std::size_t k = 0; k <= positions + 1; ++k) {
    put_back(index, bytes);
    put_back(sum, checksum);
    if (k < positions)
      io::flip_byte(index, k * bytes.size() / positions + k % 7, static_cast<char>(1 << k % 8));
    else if (k == positions)
      io::flip_byte(sum, 5);
    else
      fs::resize_file(index, bytes.size() / 2);
    Store store(path);
    EXPECT_THAT(store.index_rebuilt(), HasSubstr("not those that were left")) << k;
    expect_whole(store);
  }
  Store store(path);
  EXPECT_EQ(store.index_rebuilt(), "");
  expect_whole(store);
}

TEST(Index, ChecksEveryRowAfterARunThatWasKilled) {
  const io::TestFolder folder;
  const fs::path path = filled(folder), index = path / "index.sqlite";
  const std::string bytes = bytes_of(index);
  for (const char* inside :
       {"odd.step", "coarse.matches", "/data/a.pcd", "CREATE TABLE facts", "SQLite format"}) {
    put_back(index, bytes);
    fs::remove(path / "index.sum");
    const auto at = bytes.find(inside);
    ASSERT_NE(at, std::string::npos);
    io::flip_byte(index, at + 2, 1);
    Store store(path);
    EXPECT_NE(store.index_rebuilt(), "") << inside;
    expect_whole(store);
  }
}

/// As kills leave it at different moments of its first making: no byte, a database without tables,
/// and one that was not committed.
TEST(Index, ThatWasNotMadeToItsEndIsMadeWithoutAWord) {
  for (const char* made : {"", "PRAGMA journal_mode = WAL; VACUUM",
                           "PRAGMA journal_mode = WAL; BEGIN; CREATE TABLE results(key BLOB)"}) {
    const io::TestFolder folder;
    const fs::path path = filled(folder);
    fs::remove(path / "index.sum");
    fs::remove(path / "index.sqlite");
    put_back(path / "index.sqlite", "");
    in_another_process([&] {
      if (*made) Database(path / "index.sqlite").run(made);
      kill(getpid(), SIGKILL);
    });
    Store store(path);
    EXPECT_EQ(store.index_rebuilt() + store.index_fault(), "") << made;
    expect_whole(store);
  }
}

TEST(Index, KnowsWhatAKilledRunHadKept) {
  const io::TestFolder folder;
  const fs::path path = filled(folder);
  const int ended = in_another_process([&] {
    Store store(path);
    store.put({100, 1}, small_result(100), "late.step");
    store.index()->flush();
    store.put({100, 2}, small_result(100), "late.step");  // its file is there, its row is not
    store.remove({0, 0});
    raise(SIGKILL);
  });
  EXPECT_TRUE(WIFSIGNALED(ended));
  Store store(path);
  EXPECT_EQ(store.index_rebuilt(), "");
  EXPECT_EQ(store.index()->rows().size(), few + 1);
  EXPECT_TRUE(store.find({100, 2}));
}

TEST(Index, IsMendedWhileItIsUsed) {
  const io::TestFolder folder;
  const fs::path path = filled(folder);
  Store store(path);
  io::flip_byte(path / "index.sqlite", bytes_of(path / "index.sqlite").find("odd.step"), 1);
  expect_whole(store);
  EXPECT_THAT(store.index_rebuilt(), HasSubstr("table 'results'"));
  EXPECT_EQ(store.index_fault(), "");
}

TEST(Index, IsLeftToTheNextRunWhereAnotherUsesItToo) {
  const io::TestFolder folder;
  const fs::path path = filled(folder);
  {
    Store one(path), other(path);
    io::flip_byte(path / "index.sqlite", bytes_of(path / "index.sqlite").find("odd.step"), 1);
    EXPECT_TRUE(other.index()->rows().empty());
    EXPECT_THAT(other.index_fault(), HasSubstr("no other run"));
    EXPECT_TRUE(other.find({3, 21}));
    other.put({200, 1}, small_result(200), "late.step");
  }
  EXPECT_FALSE(fs::exists(path / "index.sum"));
  Store store(path);
  EXPECT_NE(store.index_rebuilt(), "");
  EXPECT_EQ(store.index()->rows().size(), few + 1);
}

TEST(Index, ThatCannotBeWrittenCostsNoResult) {
  const io::TestFolder folder;
  const fs::path path = filled(folder);
  fs::remove(path / "index.sqlite");
  fs::create_directories(path / "index.sqlite/in the way");
  Store one(path), other(path);  // neither waits for the other
  for (Store* store : {&one, &other}) {
    EXPECT_NE(store->index_fault(), "");
    EXPECT_TRUE(store->find({3, 21}));
    EXPECT_TRUE(store->put({300, 1}, small_result(300), "late.step"));
    store->sync();
    EXPECT_TRUE(store->index()->rows().empty());
  }
}

TEST(Index, IsSharedByProcesses) {
  const io::TestFolder folder;
  const fs::path path = folder.path() / "store";
  std::vector<pid_t> children;
  for (std::uint64_t p = 0; p < 4; ++p)
    if (children.push_back(fork()); children.back() == 0) {
      {
        Store store(path);
        for (std::uint64_t k = 0; k < 100; ++k) {
          store.put({p, k}, small_result(1), "a.step");
          if (k % 10 == 0) store.index()->flush();
        }
        if (!store.index_fault().empty() || !store.index_rebuilt().empty()) _exit(1);
      }
      _exit(0);
    }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_TRUE(fs::exists(path / "index.sum"));
  Store store(path);
  EXPECT_EQ(store.index_rebuilt(), "");
  EXPECT_EQ(store.index()->rows().size(), 400u);
}

}  // namespace
}  // namespace plumb
