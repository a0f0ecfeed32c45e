#include "plumb/data/file_bytes.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>

#include "plumb/data/archive.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/random.hpp"

namespace plumb {
namespace {

/// Pieces of many sizes, `n` bytes in all.
std::string grown(std::size_t n, FileBytes& bytes) {
  Random random(n);
  std::string expected;
  while (expected.size() < n) {
    std::string piece(
        std::min<std::size_t>(n - expected.size(),
                              random.below(8) ? random.below(100000) : random.below(3 << 20)),
        '\0');
    for (std::size_t k = 0; k < piece.size(); k += 97) piece[k] = static_cast<char>(random.next());
    bytes.append(piece);
    expected += piece;
  }
  return expected;
}

TEST(FileBytes, GiveBackWhatWasAppendedInMemoryAndBeyond) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1000}, std::size_t{16} << 20,
                              (std::size_t{16} << 20) + 1, std::size_t{40} << 20}) {
    FileBytes bytes;
    const std::string expected = grown(n, bytes);
    ASSERT_EQ(bytes.size(), n);
    EXPECT_TRUE(bytes.text() == expected) << n;
    FileBytes copy = bytes;
    copy.append("more");
    EXPECT_EQ(bytes.size(), n);
    EXPECT_TRUE(copy.text() == expected + "more") << n;
    copy = std::move(bytes);
    EXPECT_TRUE(copy.text() == expected) << n;
  }
}

TEST(FileBytes, AreHashedAndStoredAsATextIs) {
  FileBytes bytes;
  const std::string text = grown(std::size_t{20} << 20, bytes);
  EXPECT_EQ(content_hash(bytes), content_hash(text));
  const std::string stored = to_bytes(bytes);
  EXPECT_TRUE(stored == to_bytes(text));
  EXPECT_TRUE(from_bytes<FileBytes>(stored).text() == text);
}

TEST(ScratchFile, LeavesNothingBehindInItsFolder) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "plumb_scratch";
  std::filesystem::create_directories(folder);
  setenv("TMPDIR", folder.c_str(), 1);
  io::ScratchFile file;
  unsetenv("TMPDIR");
  EXPECT_EQ(file.append("one", 3), 0u);
  EXPECT_EQ(file.append("three", 5), 3u);
  char back[6] = {};
  file.read(2, back, 5);
  EXPECT_STREQ(back, "ethre");
  EXPECT_THROW(file.read(6, back, 5), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace plumb
