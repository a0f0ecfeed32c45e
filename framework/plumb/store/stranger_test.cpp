/// Stores that somebody else owns, may write, or has put pipes and links into.
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/index.hpp"
#include "plumb/store/store_testing.hpp"
#include "plumb/store/upkeep.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr uid_t stranger = 4'000'123;
const Hash128 key{1, 2};

mode_t mode_of(const fs::path& path) {
  struct stat at {};
  EXPECT_EQ(lstat(path.c_str(), &at), 0);
  return at.st_mode & 07777;
}

struct Stranger : testing::Test {
  io::TestFolder folder;
  fs::path path = folder.path() / "store";

  Stranger() { Store(path).put(key, small_result(5), "a.step"); }
  std::string refused(Whose whose = Whose::own) const {
    return io::refusal([&] { Store(path, StoreRole::driver, whose); });
  }
  fs::path blob() const { return blob_file(path, key); }
  /// Whatever stands in the place of the blob is damage: removed, told, and made again.
  void expect_made_again(const std::string& why) const {
    Store store(path);
    EXPECT_FALSE(store.find(key));
    EXPECT_FALSE(store.contains(key));
    EXPECT_EQ(store.damaged(), 1u);
    EXPECT_EQ(store.damage(), key.text() + " " + why);
    EXPECT_TRUE(store.put(key, small_result(6), "a.step"));
    EXPECT_EQ(x_of(*store.find(key)), 6);
  }
};

TEST_F(Stranger, HasNoWayIntoAStoreThatIsMade) {
  EXPECT_EQ(mode_of(path), 0700u);
  fs::create_directory(folder.path() / "deep");
  chmod((folder.path() / "deep").c_str(), 0755);
  const mode_t before = umask(0);
  { Store store(folder.path() / "deep/er/"); }
  umask(before);
  EXPECT_EQ(mode_of(folder.path() / "deep/er"), 0700u);
}

TEST_F(Stranger, MayWriteNoStoreThatIsTaken) {
  for (const mode_t mode : {0777, 0770, 0702, 01777}) {
    chmod(path.c_str(), mode);
    EXPECT_THAT(refused(), AllOf(HasSubstr("may be written by"), HasSubstr("chmod -R go-w"),
                                 HasSubstr("--trust-cache")))
        << mode;
    EXPECT_EQ(x_of(*Store(path, StoreRole::driver, Whose::anyones).find(key)), 5);
    EXPECT_THAT(io::refusal([&] { Store(path, StoreRole::worker); }), HasSubstr("--trust-cache"));
  }
  chmod(path.c_str(), 0755);
  EXPECT_TRUE(Store(path).find(key));
}

TEST_F(Stranger, IsShutOutAsTheSentenceSays) {
  // As an earlier version made it under umask 002.
  for (const fs::path& made : {path, path / "plumb-store", blob()})
    fs::permissions(made, fs::perms::group_write, fs::perm_options::add);
  EXPECT_THAT(refused(), HasSubstr("chmod -R go-w '" + path.string() + "'"));
  chmod(path.c_str(), 0755);
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("'plumb-store' belongs to another user, or may be written"),
                    HasSubstr("chmod -R go-w '" + path.string() + "'")));
  ASSERT_EQ(std::system(("chmod -R go-w '" + path.string() + "'").c_str()), 0);
  EXPECT_TRUE(Store(path).find(key));
}

TEST_F(Stranger, MayWriteNoFolderAboveUnlessItIsSticky) {
  chmod(folder.path().c_str(), 0777);
  EXPECT_THAT(refused(), HasSubstr(folder.path().string() + " may be written by everybody"));
  EXPECT_THAT(io::refusal([&] { Store(folder.path() / "another"); }),
              HasSubstr("may be written by everybody"));
  EXPECT_FALSE(fs::exists(folder.path() / "another"));
  chmod(folder.path().c_str(), 01777);
  EXPECT_TRUE(Store(path).find(key));
}

TEST_F(Stranger, OwnsNoStoreThatIsTaken) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder away";
  ASSERT_EQ(chown(path.c_str(), stranger, 0), 0);
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("belongs to user number 4000123"), HasSubstr("--trust-cache")));
  EXPECT_EQ(x_of(*Store(path, StoreRole::driver, Whose::anyones).find(key)), 5);
}

TEST_F(Stranger, OwnsNoResultThatIsTaken) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a file away";
  ASSERT_EQ(chown(blob().c_str(), stranger, 0), 0);
  expect_made_again("belongs to another user, or may be written by others");
}

TEST_F(Stranger, MayWriteNoResultThatIsTaken) {
  chmod(blob().c_str(), 0666);
  expect_made_again("belongs to another user, or may be written by others");
}

TEST_F(Stranger, PutAPipeInThePlaceOfAResult) {
  fs::remove(blob());
  mkfifo(blob().c_str(), 0600);
  expect_made_again("is not a regular file");
}

TEST_F(Stranger, PutALinkInThePlaceOfAResult) {
  fs::rename(blob(), folder.path() / "elsewhere");
  fs::create_symlink(folder.path() / "elsewhere", blob());
  expect_made_again("is not a regular file");
  EXPECT_TRUE(fs::exists(folder.path() / "elsewhere"));
}

TEST_F(Stranger, PutASocketInThePlaceOfAResult) {
  fs::remove(blob());
  const int number = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, blob().c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(number, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(number);
  expect_made_again("is not a regular file");
}

TEST_F(Stranger, PutALinkInThePlaceOfAFolder) {
  const fs::path part = blob().parent_path(), elsewhere = folder.path() / "elsewhere";
  fs::rename(part, elsewhere);
  fs::create_symlink(elsewhere, part);
  EXPECT_THAT(refused(), HasSubstr("holds a link"));
  fs::remove(part);
  fs::rename(path / "new", elsewhere / "new");
  fs::create_symlink(elsewhere / "new", path / "new");
  EXPECT_THAT(refused(), HasSubstr("its 'new' is not a directory of its own"));
  fs::remove(path / "new");
  fs::create_symlink(elsewhere, path / "jobs");
  EXPECT_THAT(refused(), HasSubstr("its 'jobs' is not a directory of its own"));
  fs::remove(path / "jobs");
  fs::remove(path / "runs");
  fs::create_symlink(elsewhere, path / "runs");
  EXPECT_THAT(refused(), HasSubstr("its 'runs' is not a directory of its own"));
}

TEST_F(Stranger, PutAPipeInThePlaceOfTheMark) {
  fs::remove(path / "plumb-store");
  mkfifo((path / "plumb-store").c_str(), 0600);
  EXPECT_THAT(refused(), HasSubstr("its file 'plumb-store' is not a regular file"));
  EXPECT_THAT(refused(Whose::anyones), HasSubstr("is not a regular file"));
}

TEST_F(Stranger, PutAPipeOrALinkInThePlaceOfTheIndex) {
  for (const char* name : {"index.sqlite", "index.sqlite-wal", "index.sqlite-shm", "index.sum"})
    for (const bool pipe : {true, false}) {
      fs::remove(path / name);
      if (pipe)
        mkfifo((path / name).c_str(), 0600);
      else
        fs::create_symlink(folder.write("theirs", "not to be touched"), path / name);
      Store store(path);
      EXPECT_NE(store.index_rebuilt(), "") << name;
      EXPECT_EQ(store.index_fault(), "") << name;
      EXPECT_EQ(store.index()->rows().size(), 1u) << name;
      if (!pipe) {
        EXPECT_EQ(fs::file_size(folder.path() / "theirs"), 17u) << name;
      }
    }
}

TEST_F(Stranger, PutAPipeOrALinkInThePlaceOfTheLock) {
  for (const bool pipe : {true, false}) {
    fs::remove(path / "index.lock");
    if (pipe)
      mkfifo((path / "index.lock").c_str(), 0600);
    else
      fs::create_symlink(folder.path() / "theirs", path / "index.lock");
    Store store(path);
    EXPECT_THAT(store.index_fault(),
                AllOf(HasSubstr("index.lock' is not a regular file"), HasSubstr("remove it")));
    EXPECT_EQ(x_of(*store.find(key)), 5);
    EXPECT_FALSE(fs::exists(folder.path() / "theirs"));
  }
}

TEST_F(Stranger, IsFoundByVerify) {
  {
    Store store(path);
    for (std::uint64_t k = 1; k < 4; ++k) store.put({9, k}, small_result(1), "a.step");
  }
  fs::remove(blob_file(path, {9, 1}));
  mkfifo(blob_file(path, {9, 1}).c_str(), 0600);
  chmod(blob_file(path, {9, 2}).c_str(), 0666);
  const toy::Poses poses{{std::numeric_limits<double>::infinity(), 2, 3}};
  ASSERT_TRUE(replace_whole(blob_file(path, {9, 3}),
                            blob_of({9, 3}, {{{any_value(poses)}}, {}, {}}, "a.step")));
  Store store(path);
  EXPECT_EQ(verify(store).damaged.size(), 3u);
  EXPECT_EQ(blobs_in(path).size(), 1u);
  EXPECT_FALSE(fs::exists(blob_file(path, {9, 1})));
}

TEST_F(Stranger, GivesNoValueThatNoStepMayGive) {
  toy::Edges edges{2, {{0, 1}}};
  const auto blob_with = [&](const AnyValue& value) {
    return blob_of(key, {{{value}}, {}, {}}, "a.step");
  };
  std::string why;
  EXPECT_TRUE(read_blob(key, blob_with(any_value(edges)), &why));
  EXPECT_EQ(why, "");
  edges.list[0].j = 1'000'000;
  EXPECT_FALSE(read_blob(key, blob_with(any_value(edges)), &why));
  EXPECT_THAT(why, HasSubstr("holds an edge between segments that there are not"));
  EXPECT_FALSE(check_blob(key, blob_with(any_value(edges))));
  const toy::Matches matches{{1, 2, 3}, {}, {}};
  EXPECT_FALSE(read_blob(key, blob_with(any_value(matches)), &why));
  EXPECT_THAT(why, HasSubstr("columns are not equally long"));
  EXPECT_FALSE(read_blob(key, blob_with(any_value(edges)).substr(0, 90), &why));
  EXPECT_EQ(why, "was cut or altered");
}

}  // namespace
}  // namespace plumb
