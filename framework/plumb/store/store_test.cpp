#include "plumb/store/store.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>
#include <thread>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/store/blob.hpp"
#include "plumb/store/store_testing.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Store, GivesBackWhatWasPutInAnotherRunToo) {
  const io::TestFolder folder;
  const Hash128 key{1, 2};
  {
    Store store(folder.path() / "deep/store");
    EXPECT_FALSE(store.find(key));
    store.put(key, small_result(5), "a.step");
    EXPECT_EQ(x_of(*store.find(key)), 5);
  }
  Store again(folder.path() / "deep/store");
  const auto found = again.find(key);
  ASSERT_TRUE(found);
  EXPECT_EQ(x_of(*found), 5);
  ASSERT_EQ(found->outputs.size(), 3u);
  EXPECT_EQ(found->outputs[1].size(), 2u);
  EXPECT_TRUE(found->outputs[2].empty());
  EXPECT_EQ(found->counts,
            (std::vector<std::pair<std::string, std::uint64_t>>{{"points dropped", 7}}));
  EXPECT_EQ(found->warnings, std::vector<std::string>{"poor"});
  EXPECT_FALSE(again.find({1, 3}));
  EXPECT_TRUE(fs::is_empty(folder.path() / "deep/store/new"));
}

TEST(Store, NoticesEachByteThatChanged) {
  const std::string good = blob_of({1, 2}, small_result(5), "a.step");
  ASSERT_TRUE(read_blob({1, 2}, good));
  EXPECT_FALSE(read_blob({1, 3}, good));  // under another name
  for (std::size_t k = 0; k < good.size(); ++k) {
    std::string bad = good;
    bad[k] = static_cast<char>(bad[k] ^ 0x10);
    EXPECT_FALSE(read_blob({1, 2}, bad)) << k;
    EXPECT_FALSE(read_blob({1, 2}, good.substr(0, k))) << k;
  }
  EXPECT_FALSE(read_blob({1, 2}, good + "x"));
}

TEST(Store, RemovesWhatIsDamagedAndTakesItAgain) {
  const io::TestFolder folder;
  Store store(folder.path() / "store");
  store.put({1, 2}, small_result(5), "a.step");
  const auto files = blobs_in(store.folder());
  ASSERT_EQ(files.size(), 1u);
  fs::resize_file(files[0], fs::file_size(files[0]) - 3);
  EXPECT_FALSE(store.find({1, 2}));
  EXPECT_EQ(store.damaged(), 1u);
  EXPECT_TRUE(blobs_in(store.folder()).empty());
  store.put({1, 2}, small_result(6), "a.step");
  EXPECT_EQ(x_of(*store.find({1, 2})), 6);
}

TEST(Store, MakesAgainWhateverByteOfAFileChanged) {
  const io::TestFolder folder;
  Store store(folder.path() / "store");
  for (std::size_t k = 0; k < 40; ++k) {
    store.put({1, 2}, small_result(static_cast<double>(k)), "a.step");
    const fs::path file = blobs_in(store.folder()).at(0);
    io::flip_byte(file, k * fs::file_size(file) / 40);
    EXPECT_FALSE(store.find({1, 2})) << k;
    EXPECT_FALSE(store.contains({1, 2}));
  }
  EXPECT_EQ(store.damaged(), 40u);
}

TEST(Store, LaysArraysWhereTheyCanBeMapped) {
  toy::Segment segment{{0, 10}, {}, std::vector<std::uint16_t>(77, 9)};
  toy::Matches matches;
  for (int k = 0; k < 77; ++k) {
    const auto f = static_cast<float>(k);
    segment.points.push_back(0.1f + f), matches.p.push_back(-2.5f * f);
    matches.q.push_back(1e-3f * f * f), matches.weight.push_back(100 + f / 3);
  }
  const std::string blob =
      blob_of({1, 2}, {{{any_value(segment)}, {any_value(matches)}}, {}, {}}, "a.step");
  const auto place_of = [&](const auto& array) {
    return blob.find(std::string_view(reinterpret_cast<const char*>(array.data()),
                                      array.size() * sizeof array[0]));
  };
  for (const auto* array : {&segment.points, &matches.p, &matches.q, &matches.weight}) {
    ASSERT_NE(place_of(*array), std::string::npos);
    EXPECT_EQ(place_of(*array) % 16, 0u);
  }
  EXPECT_EQ(place_of(segment.frame) % 16, 0u);
  const auto back = read_blob({1, 2}, blob);
  ASSERT_TRUE(back);
  EXPECT_EQ(content_hash(*back->outputs[0][0].as<toy::Segment>()), content_hash(segment));
  EXPECT_EQ(content_hash(*back->outputs[1][0].as<toy::Matches>()), content_hash(matches));
}

TEST(Store, HashesArraysWithoutWhatAlignsThem) {
  const toy::Features value{{1, 2, 3}};
  Hasher hasher;
  const std::uint64_t size = 3;
  hasher.bytes(&size, sizeof size);
  hasher.bytes(value.values.data(), 3 * sizeof(float));
  EXPECT_EQ(content_hash(value), hasher.hash());
  EXPECT_EQ(to_bytes(value).size(), 16 + 3 * sizeof(float));
}

TEST(Store, LetsWorkersLeaveTheIndexAlone) {
  const io::TestFolder folder;
  {
    EXPECT_THROW(Store(folder.path() / "store", StoreRole::worker), Error);  // the run makes it
    fs::create_directory(folder.path() / "store");
    std::ofstream(folder.path() / "store/plumb-store") << "plumb store 2\n";
    for (const char* made : {"store", "store/plumb-store"})
      fs::permissions(folder.path() / made, fs::perms::group_write | fs::perms::others_write,
                      fs::perm_options::remove);
    Store worker(folder.path() / "store", StoreRole::worker);
    worker.put({1, 2}, small_result(5), "a.step");
    EXPECT_FALSE(worker.index());
  }
  EXPECT_FALSE(fs::exists(folder.path() / "store/index.sqlite"));
  Store driver(folder.path() / "store");
  EXPECT_TRUE(driver.contains({1, 2}));
  EXPECT_EQ(driver.bytes_of({1, 2}), fs::file_size(blobs_in(driver.folder()).at(0)));
  EXPECT_EQ(driver.bytes_of({1, 3}), 0u);
  EXPECT_EQ(driver.index_rebuilt(), "");
}

TEST(Store, TakesResultsOfTypesItDoesNotKnowForNone) {
  std::string blob = blob_of({1, 2}, small_result(5), "a.step");
  const auto at = blob.find("Poses");
  ASSERT_NE(at, std::string::npos);
  blob.replace(at, 5, "Posts");
  // With a checksum that fits: a type of a later program.
  Hasher hasher;
  hasher.bytes(blob.data(), blob.size() - 16);
  const Hash128 sum = hasher.hash();
  std::memcpy(blob.data() + blob.size() - 16, &sum.high, 8);
  std::memcpy(blob.data() + blob.size() - 8, &sum.low, 8);
  EXPECT_FALSE(read_blob({1, 2}, blob));
}

TEST(Store, RefusesFoldersOfOthersAndOtherFormats) {
  const io::TestFolder folder;
  const auto said = [&](const fs::path& path) { return io::refusal([&] { Store store(path); }); };
  folder.write("thesis.tex", "mine");
  EXPECT_THAT(said(folder.path()), HasSubstr("is not a cache"));
  EXPECT_THAT(said(folder.path() / "thesis.tex"), HasSubstr("is not a cache"));
  { Store store(folder.path() / "later"); }
  std::ofstream(folder.path() / "later/plumb-store") << "plumb store 9\n";
  EXPECT_THAT(said(folder.path() / "later"),
              testing::AllOf(HasSubstr("another format"), HasSubstr("plumb store 9")));
}

TEST(Store, IsSharedByThreadsAndRuns) {
  const io::TestFolder folder;
  Store one(folder.path() / "store"), other(folder.path() / "store");
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        Store& store = t % 2 ? one : other;
        for (std::uint64_t k = 0; k < 200; ++k) {
          store.put({9, k}, small_result(static_cast<double>(k)), "a.step");
          const auto found = store.find({9, k});
          ASSERT_TRUE(found && x_of(*found) == static_cast<double>(k));
        }
      });
  }
  EXPECT_EQ(blobs_in(one.folder()).size(), 200u);
  EXPECT_TRUE(fs::is_empty(one.folder() / "new"));
  EXPECT_EQ(one.damaged() + other.damaged(), 0u);
}

}  // namespace
}  // namespace plumb
