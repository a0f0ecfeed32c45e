#include <gmock/gmock.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

#include "plumb/data/error.hpp"
#include "plumb/engine/results.hpp"
#include "plumb/engine/output_folder.hpp"
#include "plumb/engine/parallel.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

TEST(Parallel, VisitsEachIndexOnceAlsoWhenNested) {
  std::vector<std::atomic<int>> visits(50 * 20);
  with_threads(2, [&] {
    parallel_for(50, [&](std::size_t i) { parallel_for(20, [&](std::size_t j) { ++visits[i * 20 + j]; }); });
  });
  for (const auto& v : visits) EXPECT_EQ(v, 1);
}

TEST(Parallel, RethrowsWhatABodyThrew) {
  const auto run = [] { parallel_for(100, [](std::size_t k) { if (k == 7) throw Error("seven"); }); };
  EXPECT_THROW(run(), Error);
}

TEST(Results, ForgetsWhatWasNotUsedForLongest) {
  const auto value = [](std::size_t n) {
    StoredResult result;
    result.outputs.push_back({any_value(Descriptor{std::vector<float>(n)})});
    return result;
  };
  Results results(nullptr, false, 10'000);
  results.remember({0, 1}, value(1000));
  results.remember({0, 2}, value(1000));
  EXPECT_TRUE(results.find({0, 1}));
  results.remember({0, 3}, value(1000));  // 12,000 bytes: 2 goes, 1 was used later
  EXPECT_TRUE(results.find({0, 1}));
  EXPECT_FALSE(results.find({0, 2}));
  EXPECT_TRUE(results.find({0, 3}));
}

struct Folder : testing::Test {
  fs::path base = fs::temp_directory_path() / ("plumb_folder_" + std::to_string(getpid()));
  RunRecord record;
  Folder() { fs::create_directories(base); }
  ~Folder() override { fs::remove_all(base); }
  static RunResult with(const std::string& name, const std::string& bytes) {
    RunResult result;
    result.documents.push_back({"out", std::make_shared<const Document>(Document{name, bytes})});
    return result;
  }
  static std::string read(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Folder, IsReplacedWhenItHoldsAnEarlierRun) {
  OutputFolder(base / "out").fill(record, with("a.txt", "one"));
  OutputFolder(base / "out").fill(record, with("b.txt", "two"));
  EXPECT_FALSE(fs::exists(base / "out/a.txt"));
  EXPECT_EQ(read(base / "out/b.txt"), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(base), {}), 1);  // nothing lies beside it
}

TEST_F(Folder, IsNotTouchedWhenItHoldsSomethingElse) {
  OutputFolder(base / "out").fill(record, with("a.txt", "one"));
  std::ofstream(base / "out/mine.txt") << "mine";
  EXPECT_THROW(OutputFolder(base / "out"), Error);
  EXPECT_EQ(read(base / "out/mine.txt"), "mine");
  EXPECT_EQ(read(base / "out/a.txt"), "one");
}

TEST_F(Folder, LeavesNothingBehindWhenTheRunFails) {
  { const OutputFolder folder(base / "out"); }
  EXPECT_TRUE(fs::is_empty(base));
}

TEST_F(Folder, RefusesAPlaceThatCannotBeWritten) {
  std::ofstream(base / "file") << "x";
  EXPECT_THROW(OutputFolder(base / "file/out"), Error);
  EXPECT_THROW(OutputFolder(base / "file"), Error);
}

TEST_F(Folder, RefusesTwoFilesOfOneNameAndNamesThatLeaveTheFolder) {
  RunResult two = with("a.txt", "one");
  two.documents.push_back({"other", two.documents[0].document});
  EXPECT_THROW(OutputFolder(base / "out").fill(record, two), Error);
  EXPECT_THROW(OutputFolder(base / "out").fill(record, with("../a.txt", "")), Error);
  EXPECT_TRUE(fs::is_empty(base));
}

}  // namespace
}  // namespace plumb
