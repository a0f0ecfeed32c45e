#include "plumb/plugin/build_identity.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/trusted_file.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

/// As `readelf -n` says it; "" where there is no readelf.
std::string told_by_readelf(const fs::path& library) {
  const std::string command = "readelf -n '" + library.string() + "' 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (char line[512]; pipe && std::fgets(line, sizeof line, pipe);) text += line;
  if (pipe) pclose(pipe);
  const auto at = text.find("Build ID: ");
  return at == std::string::npos ? "" : text.substr(at + 10, text.find('\n', at) - at - 10);
}

TEST(BuildIdentity, IsWhatTheLinkerWrote) {
  const std::string told = told_by_readelf(this_library());
  if (told.empty())
    GTEST_SKIP() << "skipped: there is no readelf, or the linker writes no build ID";
  EXPECT_EQ(build_of(this_library()), told);
}

TEST(BuildIdentity, StaysWhereTheFileIsCopiedAndItsPathsAreChanged) {
  const io::TestFolder folder;
  const fs::path copy = folder.path() / "copy.so";
  fs::copy_file(this_library(), copy);
  EXPECT_EQ(build_of(copy), build_of(this_library()));
}

TEST(BuildIdentity, OfAFileWithoutOneIsThatOfItsBytes) {
  const io::TestFolder folder;
  const auto one = folder.write("a.so", "no ELF at all"),
             same = folder.write("b.so", "no ELF at all"),
             other = folder.write("c.so", "no ELF at aLL"), empty = folder.write("d.so", "");
  EXPECT_EQ(build_of(one), build_of(same));
  EXPECT_NE(build_of(one), build_of(other));
  EXPECT_NE(build_of(empty), build_of(other));
  EXPECT_ANY_THROW(build_of(folder.path() / "none.so"));
}

TEST(BuildIdentity, DamagedHeadersEndInAHash) {
  const io::TestFolder folder;
  std::ifstream in(this_library(), std::ios::binary);
  std::string head(4096, '\0');
  in.read(head.data(), 4096);
  for (const std::size_t cut : {4u, 40u, 63u, 64u, 100u, 700u})
    EXPECT_FALSE(build_of(folder.write("cut.so", head.substr(0, cut))).empty());
  for (std::size_t at = 4; at < 1024; at += 7) {
    std::string changed = head;
    changed[at] = '\xff';
    EXPECT_FALSE(build_of(folder.write("changed.so", changed)).empty());
  }
}

}  // namespace
}  // namespace plumb
