#include "plumb/engine/remote/slurm/job_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "plumb/data/io/file_testing.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

/// As a chunk writes it: its size and its bytes.
std::string notice_of(std::uint64_t item) {
  Notice notice{true, {}};
  notice.reply.item = item;
  const std::string bytes = to_bytes(notice);
  const std::uint64_t size = bytes.size();
  return std::string(reinterpret_cast<const char*>(&size), sizeof size) + bytes;
}

std::vector<std::uint64_t> items_of(const std::vector<Notice>& news) {
  std::vector<std::uint64_t> items;
  for (const Notice& notice : news) items.push_back(notice.reply.item);
  return items;
}

TEST(JobFolder, TellsEachNoticeOnceAsSoonAsItIsWhole) {
  const io::TestFolder folder;
  JobFolder job(folder.path());
  EXPECT_TRUE(job.news().empty());
  const std::string all = notice_of(7) + notice_of(8) + notice_of(9);
  std::vector<std::uint64_t> seen;
  for (std::size_t size = 0; size <= all.size(); size += 5) {
    folder.write("replies/1-1.0", all.substr(0, size));
    for (const auto item : items_of(job.news())) seen.push_back(item);
  }
  folder.write("replies/1-1.0", all);
  for (const auto item : items_of(job.news())) seen.push_back(item);
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{7, 8, 9}));
  EXPECT_TRUE(job.news().empty());
}

TEST(JobFolder, PassesOverWhatIsNoNotice) {
  const io::TestFolder folder;
  JobFolder job(folder.path());
  const std::uint64_t three = 3, endless = ~std::uint64_t{0};
  const auto number = [](const std::uint64_t& n) {
    return std::string(reinterpret_cast<const char*>(&n), sizeof n);
  };
  folder.write("replies/1-1.0", number(three) + "abc" + notice_of(4));
  folder.write("replies/1-1.1", number(endless) + notice_of(5));
  std::vector<std::uint64_t> seen;
  for (int time = 0; time < 3; ++time)
    for (const auto item : items_of(job.news())) seen.push_back(item);
  EXPECT_EQ(seen, std::vector<std::uint64_t>{4});
}

TEST(JobFolder, WaitsForNoPipeAndFollowsNoLink) {
  const io::TestFolder folder;
  JobFolder job(folder.path());
  folder.write("replies/1-1.0", notice_of(3));
  mkfifo((folder.path() / "replies/1-1.1").c_str(), 0600);
  fs::create_symlink(folder.write("theirs", notice_of(6)), folder.path() / "replies/1-1.2");
  EXPECT_EQ(items_of(job.news()), std::vector<std::uint64_t>{3});
  mkfifo((folder.path() / "submitted").c_str(), 0600);
  EXPECT_FALSE(job.submitted());
  mkfifo((folder.path() / "1.task").c_str(), 0600);
  EXPECT_NE(io::refusal([&] { read_task(folder.path() / "1.task"); }).find("there is no such task"),
            std::string::npos);
}

}  // namespace
}  // namespace plumb
