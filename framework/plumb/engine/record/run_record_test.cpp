#include "plumb/engine/record/run_record.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "plumb/data/error.hpp"
#include "plumb/engine/record/quoted.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Record : testing::Test {
  fs::path folder = fs::temp_directory_path() / ("plumb_record_" + std::to_string(getpid()));
  fs::path input = folder / "input";
  Record() {
    fs::create_directories(input / "frames");
    write("frames/0.pcd", "zero");
    write("frames/1.pcd", "one");
    write("odometry.tum", "poses");
  }
  ~Record() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(input / name) << text;
  }
  RunRecord some() const {
    RunRecord record;
    record.plumb = "0.1.0", record.abi = "an: \"abi\"", record.library = "l", record.name = "n";
    record.files = {{"map.ply", 12, {1, 2}},
                    {"a b.txt", 0, {}},
                    {"\"odd\n.txt", 1, {3, 4}},
                    {"- x: {bytes: 1, hash: 2}", 5, {~0ull, 6}}};
    record.steps = {{"a.b", "test.keep", 3, "0123"}, {"c", "test.sum", 1, ""}};
    record.inputs = {input_record(input.string(), true),
                     input_record((input / "odometry.tum").string(), false)};
    record.pipeline = "plumb: 1\n\nsteps:\n  a: {use: x}  # \xff\n";
    return record;
  }
  fs::path lock(const std::string& text) const {
    std::ofstream(folder / "run.lock.yaml", std::ios::binary) << text;
    return folder / "run.lock.yaml";
  }
};

TEST_F(Record, IsReadBackAsItWasWritten) {
  const RunRecord record = some();
  const RunRecord read = read_lock(lock(lock_text(record)));
  EXPECT_EQ(lock_text(read), lock_text(record));
  EXPECT_EQ(read.files, record.files);
  EXPECT_EQ(read.steps, record.steps);
  EXPECT_EQ(read.pipeline, record.pipeline);
  EXPECT_EQ(read.inputs[0].content, record.inputs[0].content);
  EXPECT_TRUE(differences(record, read).empty());
}

TEST_F(Record, OfAnInputLeavesOutWhatAnotherRunStages) {
  const InputRecord before = input_record(input.string(), true);
  fs::create_directories(input / ".out.plumb-0123456789ab");
  write(".out.plumb-0123456789ab/half.ply", "half");
  write(".out.plumb-0123456789ab.lock", "token");
  EXPECT_EQ(input_record(input.string(), true).content, before.content);
  fs::create_directories(input / "scan.partial-1");  // a user's own
  write("scan.partial-1/2.pcd", "two");
  EXPECT_EQ(input_record(input.string(), true).files, before.files + 1);
}

TEST_F(Record, OfTheFilesIsTakenOnlyFromATextThatWasNotEdited) {
  const RunRecord record = some();
  const std::string text = lock_text(record);
  ASSERT_TRUE(files_of_lock(text));
  EXPECT_EQ(*files_of_lock(text), record.files);
  for (std::size_t at = 0; at < text.size(); at += 7) {
    std::string edited = text;
    edited[at] ^= 1;
    EXPECT_FALSE(files_of_lock(edited)) << at;
  }
  EXPECT_FALSE(files_of_lock(text + "more\n"));
  EXPECT_FALSE(files_of_lock(text.substr(0, text.find("files:"))));
}

TEST_F(Record, IsRefusedWhereverItIsCut) {
  const std::string text = lock_text(some());
  for (std::size_t n = 0; n + 1 < text.size(); n += 3)
    EXPECT_THROW(read_lock(lock(text.substr(0, n))), Error) << n;
  EXPECT_THROW(read_lock(lock(text + "more\n")), Error);
  EXPECT_THROW(read_lock(folder), Error);
  EXPECT_THROW(read_lock(folder / "none"), Error);
}

TEST_F(Record, OfAnInputChangesWithNameSizeTimeAndContent) {
  const InputRecord first = input_record(input.string(), true);
  EXPECT_EQ(first.files, 3u);
  EXPECT_EQ(first.bytes, 12u);
  const auto time = fs::last_write_time(input / "frames/1.pcd");
  write("frames/1.pcd", "two");
  fs::last_write_time(input / "frames/1.pcd", time);
  EXPECT_EQ(input_record(input.string(), false).digest,
            first.digest);  // nobody looked at the content
  EXPECT_NE(input_record(input.string(), true).content, first.content);
  write("frames/1.pcd", "one");
  fs::last_write_time(input / "frames/1.pcd", time + std::chrono::seconds(1));
  EXPECT_NE(input_record(input.string(), false).digest, first.digest);
  EXPECT_EQ(input_record(input.string(), true).content, first.content);
  fs::rename(input / "frames/1.pcd", input / "frames/2.pcd");
  EXPECT_NE(input_record(input.string(), true).content, first.content);
  EXPECT_EQ(input_record((folder / "none").string(), true).files, 0u);
}

TEST_F(Record, OfAnInputLeavesOutWhatRunsLeftInItAndEndsInALoopOfLinks) {
  const InputRecord first = input_record(input.string(), true);
  fs::create_directories(input / "out");
  write("out/run.lock.yaml", "x");
  write("out/map.ply", "x");
  fs::create_directories(input / "store/blobs");
  write("store/plumb-store", "x");
  fs::create_directory_symlink("..", input / "frames/loop");
  EXPECT_EQ(input_record(input.string(), true).files, first.files);
  EXPECT_EQ(input_record(input.string(), true).digest, first.digest);
}

TEST_F(Record, NamesEachDifferenceWithBothValues) {
  const RunRecord then = some();
  RunRecord now = then;
  now.plumb = "9.9.9", now.abi = "other", now.library = "m";
  now.steps[0].version = 4;
  now.steps[1].version = 0;
  now.inputs[0].files = 2;
  now.inputs[1].digest = {1, 2};
  const auto all = differences(then, now);
  ASSERT_EQ(all.size(), 7u);
  EXPECT_THAT(all[0], HasSubstr("plumb was version 0.1.0, is version 9.9.9"));
  EXPECT_THAT(all[3], HasSubstr("step 'a.b' (test.keep) was version 3, is version 4"));
  EXPECT_THAT(all[4], HasSubstr("is not installed"));
  EXPECT_THAT(all[5], HasSubstr("was 3 files, is 2"));
  EXPECT_THAT(all[6], HasSubstr("--verify-inputs"));
}

TEST_F(Record, OfTimesIsNothingWhereTheContentIsKnown) {
  const RunRecord then = some();
  RunRecord now = then;
  now.inputs[0].digest = {1, 2};
  EXPECT_TRUE(differences(then, now).empty());
  now.inputs[0].content = Hash128{1, 2};
  EXPECT_THAT(differences(then, now).at(0), HasSubstr("the content of the input"));
}

TEST_F(Record, OfAPlanFitsItsResolvedText) {
  const Registry steps = engine_test::registry();
  std::ofstream(folder / "p.yaml") << "plumb: 1\nsteps:\n  source: {use: test.source}\n  sums: "
                                      "{use: test.sum, from: source.frames}\n"
                                      "  out: {use: test.write, from: {metrics: sums}}\n";
  const Plan plan = read_pipeline(folder / "p.yaml", {}, steps);
  const RunRecord record = record_of(plan, false);
  EXPECT_EQ(record.steps.size(), 3u);
  EXPECT_TRUE(describes(record, read_resolved(plan.resolved, "lock", steps)));
  EXPECT_TRUE(differences(record, record_now(record, steps, false)).empty());
}

TEST(Quoted, GivesBackEveryByte) {
  std::string all;
  for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
  EXPECT_EQ(from_quotes(in_quotes(all)), all);
  for (const char* wrong : {"", "\"", "a", "\"a", "\"a\"b\"", "\"\\\"", "\"\\x4\"", "\"\\q\""})
    EXPECT_FALSE(from_quotes(wrong)) << wrong;
  EXPECT_EQ(in_quotes_where_needed("map.ply"), "map.ply");
  EXPECT_EQ(in_quotes_where_needed("1"), "\"1\"");
}

}  // namespace
}  // namespace plumb
