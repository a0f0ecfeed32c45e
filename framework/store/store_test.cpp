#include "plumb/store/store.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>
#include <thread>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/store/blob.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Poses poses(double x) {
  Poses result;
  result.T_world_segment.emplace_back(Eigen::Quaterniond::Identity(), Eigen::Vector3d(x, 2, 3));
  return result;
}

StoredResult result(double x) {
  Metrics metrics;
  metrics.add("rmse", x, "m");
  return {{{any_value(poses(x))}, {any_value(metrics), any_value(metrics)}, {}}, {{"points dropped", 7}}, {"poor"}};
}

double x_of(const StoredResult& stored) { return stored.outputs[0][0].as<Poses>()->T_world_segment[0].translation.x(); }

std::vector<fs::path> blobs_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "blobs"))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

TEST(Store, GivesBackWhatWasPutInAnotherRunToo) {
  const io::TestFolder folder;
  const Hash128 key{1, 2};
  {
    Store store(folder.path() / "deep/store");
    EXPECT_FALSE(store.find(key));
    store.put(key, result(5));
    EXPECT_EQ(x_of(*store.find(key)), 5);
  }
  Store again(folder.path() / "deep/store");
  const auto found = again.find(key);
  ASSERT_TRUE(found);
  EXPECT_EQ(x_of(*found), 5);
  ASSERT_EQ(found->outputs.size(), 3u);
  EXPECT_EQ(found->outputs[1].size(), 2u);
  EXPECT_TRUE(found->outputs[2].empty());
  EXPECT_EQ(found->counts, (std::vector<std::pair<std::string, std::uint64_t>>{{"points dropped", 7}}));
  EXPECT_EQ(found->warnings, std::vector<std::string>{"poor"});
  EXPECT_FALSE(again.find({1, 3}));
  EXPECT_TRUE(fs::is_empty(folder.path() / "deep/store/new"));
}

TEST(Store, NoticesEachByteThatChanged) {
  const std::string good = blob_of({1, 2}, result(5));
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
  store.put({1, 2}, result(5));
  const auto files = blobs_in(store.folder());
  ASSERT_EQ(files.size(), 1u);
  fs::resize_file(files[0], fs::file_size(files[0]) - 3);
  EXPECT_FALSE(store.find({1, 2}));
  EXPECT_EQ(store.damaged(), 1u);
  EXPECT_TRUE(blobs_in(store.folder()).empty());
  store.put({1, 2}, result(6));
  EXPECT_EQ(x_of(*store.find({1, 2})), 6);
}

TEST(Store, TakesResultsOfTypesItDoesNotKnowForNone) {
  std::string blob = blob_of({1, 2}, result(5));
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
  EXPECT_THAT(said(folder.path()), HasSubstr("is no store"));
  EXPECT_THAT(said(folder.path() / "thesis.tex"), HasSubstr("is no store"));
  { Store store(folder.path() / "later"); }
  std::ofstream(folder.path() / "later/plumb-store") << "plumb store 9\n";
  EXPECT_THAT(said(folder.path() / "later"), testing::AllOf(HasSubstr("another format"), HasSubstr("plumb store 9")));
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
          store.put({9, k}, result(static_cast<double>(k)));
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
