#include "plumb/data/io/ownership.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plumb/data/io/file_testing.hpp"

namespace plumb::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string said(const fs::path& path, Judging judging) {
  const auto loose = looseness_of(path, judging);
  return loose ? loose->where.string() + " " + loose->what + "; " + loose->cure() : "";
}

TEST(Ownership, LetsNobodyElseWrite) {
  const TestFolder folder;
  const fs::path file = folder.write("code", "");
  for (const mode_t good : {0600, 0644, 0755, 0444}) {
    chmod(file.c_str(), good);
    EXPECT_EQ(said(file, Judging::entry), "") << good;
  }
  chmod(file.c_str(), 0664);
  EXPECT_EQ(said(file, Judging::entry),
            file.string() + " may be written by its group (mode 0664); chmod go-w '" +
                file.string() + "'");
  for (const mode_t bad : {0602, 0666, 0777}) {
    chmod(file.c_str(), bad);
    EXPECT_THAT(said(file, Judging::entry), HasSubstr("may be written by everybody")) << bad;
  }
}

TEST(Ownership, TakesStickyFoldersAboveButNotAsTheyAre) {
  const TestFolder folder;
  chmod(folder.path().c_str(), 01777);
  EXPECT_EQ(said(folder.path(), Judging::above), "");
  EXPECT_EQ(said(folder.path(), Judging::lenient), "");
  EXPECT_THAT(said(folder.path(), Judging::entry), HasSubstr("mode 1777"));
  chmod(folder.path().c_str(), 0777);
  EXPECT_THAT(said(folder.path(), Judging::above), HasSubstr("everybody"));
  EXPECT_THAT(said(folder.path(), Judging::lenient), HasSubstr("everybody"));
  chmod(folder.path().c_str(), 0775);
  EXPECT_THAT(said(folder.path(), Judging::above), HasSubstr("its group"));
  EXPECT_EQ(said(folder.path(), Judging::lenient), "");
}

TEST(Ownership, LetsNobodyElseOwn) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a file away";
  const TestFolder folder;
  const fs::path file = folder.write("code", "");
  chmod(file.c_str(), 0644);
  ASSERT_EQ(chown(file.c_str(), 4'000'123, 0), 0);
  EXPECT_THAT(said(file, Judging::entry), HasSubstr("belongs to user number 4000123; chown 0 "));
  EXPECT_THAT(said(file, Judging::above), HasSubstr("belongs to user"));
  EXPECT_EQ(said(file, Judging::lenient), "");
  EXPECT_FALSE(looseness_of(file, Judging::entry, 4'000'123));
  EXPECT_TRUE(looseness_of(file, Judging::entry, 4'000'124));
}

TEST(Ownership, SaysWhenThereIsNothingToJudge) {
  const TestFolder folder;
  EXPECT_THAT(said(folder.path() / "none", Judging::entry),
              HasSubstr("cannot be looked at (No such file"));
}

}  // namespace
}  // namespace plumb::io
