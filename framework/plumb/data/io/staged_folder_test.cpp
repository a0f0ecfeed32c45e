#include "plumb/data/io/staged_folder.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plumb/data/io/file_testing.hpp"

namespace plumb::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* cure = "name another";

/// Takes for made what begins with "made".
Listing made_files(const Folder& folder, const fs::path&) {
  Listing listing;
  const auto names = folder.names();
  for (const std::string& name : *names) {
    const auto text = folder.text(name, 100);
    if (!text || !text->starts_with("made")) throw Error("'" + name + "' is another's");
    listing.files.push_back({name, folder.stamp(name)});
  }
  return listing;
}

class Staged : public testing::Test {
 protected:
  fs::path place() const { return folder_.path() / "out"; }
  std::vector<std::string> beside() const { return *Folder(folder_.path()).names(); }
  std::string read(const std::string& name) const {
    const fs::path file = folder_.path() / name;
    return Folder(file.parent_path()).text(file.filename(), 100).value_or("(nothing)");
  }
  static void write(StagedFolder& folder, const std::string& name, const std::string& text) {
    folder.write(name, [&](const Take& take) { take(text); });
  }
  std::string make(const std::string& text) const {
    StagedFolder folder(place(), cure, made_files);
    write(folder, "a", text);
    return folder.finish();
  }
  /// Runs `action` in another process, which then kills itself.
  template <class Action>
  static void killed(Action&& action) {
    const pid_t child = fork();
    if (child == 0) {
      action();
      raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
  }

  TestFolder folder_;
};

TEST_F(Staged, AppearsWholeAndReplacesWhatWasMade) {
  EXPECT_EQ(make("made one"), "");
  EXPECT_EQ(make("made two"), "");
  EXPECT_EQ(read("out/a"), "made two");
  EXPECT_THAT(beside(), ElementsAre("out"));
}

TEST_F(Staged, LeavesNothingWithoutFinishNotEvenTheFoldersAroundIt) {
  {
    StagedFolder one(folder_.path() / "x/y/out", cure, made_files),
        two(folder_.path() / "x/z/out", cure, made_files);
    one.add_folder("inner");
    write(one, "inner/a", "made");
    write(two, "a", "made");
  }
  EXPECT_THAT(beside(), IsEmpty());
}

TEST_F(Staged, WhatAKillLeftIsRemovedByTheNextAndNothingElseIs) {
  make("made before");
  killed([&] {
    auto* folder = new StagedFolder(place(), cure, made_files);
    folder->add_folder("inner");
    write(*folder, "a", "made");
    write(*folder, "inner/b", "made");
  });
  EXPECT_EQ(beside().size(), 3u);  // marker, folder, out
  EXPECT_EQ(read("out/a"), "made before");
  EXPECT_EQ(make("made after"), "");
  EXPECT_THAT(beside(), ElementsAre("out"));
  EXPECT_EQ(read("out/a"), "made after");
}

TEST_F(Staged, WhatAUserPutIntoARemainStays) {
  killed([&] {
    auto* folder = new StagedFolder(place(), cure, made_files);
    write(*folder, "a", "made");
  });
  const std::string staging = beside().front();
  folder_.write(staging + "/thesis.tex", "mine");
  make("made");
  EXPECT_EQ(read(staging + "/thesis.tex"), "mine");
  EXPECT_FALSE(fs::exists(folder_.path() / staging / "a"));
}

TEST_F(Staged, FoldersThatLookLikeARemainStay) {
  const std::vector<std::string> names = {
      ".out.plumb-0123456789ab", ".out.plumb-backup",    "out.old-2024", "out.old-1",
      "out.partial-1",           "out.partial-999999999"};
  for (const std::string& name : names) folder_.write(name + "/thesis.tex", "mine");
  folder_.write(".out.plumb-0123456789ab.lock", "");
  folder_.write(".out.plumb-111111111111.lock", "# a text of mine\ntoken 111111111111\n");
  make("made");
  make("made again");
  for (const std::string& name : names) EXPECT_EQ(read(name + "/thesis.tex"), "mine") << name;
  EXPECT_TRUE(fs::exists(folder_.path() / ".out.plumb-111111111111.lock"));
  fs::remove_all(place());
  { const StagedFolder unfinished(place(), cure, made_files); }
  EXPECT_FALSE(fs::exists(place())) << "a backup was taken for the folder";
}

TEST_F(Staged, ACopyOfARemainUnderAnotherNameStays) {
  killed([&] { write(*new StagedFolder(place(), cure, made_files), "a", "made"); });
  const std::vector<std::string> left = beside();  // folder, marker
  fs::copy(folder_.path() / left[0], folder_.path() / ".out.plumb-0123456789ab");
  fs::copy(folder_.path() / left[1], folder_.path() / ".out.plumb-0123456789ab.lock");
  fs::copy(folder_.path() / left[0], folder_.path() / ".other.plumb-0123456789ab");
  fs::copy(folder_.path() / left[1], folder_.path() / ".other.plumb-0123456789ab.lock");
  make("made");
  EXPECT_THAT(beside(),
              ElementsAre(".other.plumb-0123456789ab", ".other.plumb-0123456789ab.lock",
                          ".out.plumb-0123456789ab", ".out.plumb-0123456789ab.lock", "out"));
}

TEST_F(Staged, WhatAnotherProcessStagesIsInUseWhateverItsNumber) {
  int ready[2], go_on[2];
  ASSERT_EQ(pipe(ready), 0);
  ASSERT_EQ(pipe(go_on), 0);
  const pid_t child = fork();
  char byte = 0;
  if (child == 0) {
    close(go_on[1]);
    StagedFolder folder(place(), cure, made_files);
    write(folder, "a", "made by the child");
    static_cast<void>(!::write(ready[1], "x", 1));
    static_cast<void>(!::read(go_on[0], &byte, 1));
    _exit(folder.finish().empty() ? 0 : 1);
  }
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_EQ(make("made by the parent"), "");
  EXPECT_EQ(read("out/a"), "made by the parent");
  ASSERT_EQ(::write(go_on[1], "x", 1), 1);
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(read("out/a"), "made by the child");
  EXPECT_THAT(beside(), ElementsAre("out"));
}

TEST_F(Staged, WhatWasMovedAwayToMakeRoomComesBack) {  // where folders cannot be exchanged
  make("made before");
  killed([&] {
    Folder parent(folder_.path());
    auto* staging = new Staging(parent, "out");
    Listing old = made_files(Folder(place()), place());
    old.inode = *parent.inode_of("out");
    if (!staging->make() || !staging->note_old(old) ||
        !move_to_new(parent, "out", staging->journal().old_name()))
      _exit(1);
  });
  EXPECT_FALSE(fs::exists(place()));
  { const StagedFolder next(place(), cure, made_files); }
  EXPECT_EQ(read("out/a"), "made before");
  EXPECT_THAT(beside(), ElementsAre("out"));
}

TEST_F(Staged, OfAFolderThatWasReplacedOnlyWhatIsUnchangedIsRemoved) {
  folder_.write("old/a", "made");
  folder_.write("old/b", "made");
  Folder parent(folder_.path());
  StagingJournal journal;
  journal.name = "old";
  journal.old = made_files(Folder(folder_.path() / "old"), "");
  journal.old.inode = *parent.inode_of("old");
  folder_.write("old/b", "edited");
  folder_.write("old/c", "mine");
  EXPECT_EQ(journal.remove(parent, "out"), ENOTEMPTY);
  EXPECT_THAT(*Folder(folder_.path() / "old").names(), ElementsAre("b", "c"));
}

TEST_F(Staged, AnotherFoldersFilesAreRefusedAndKept) {
  folder_.write("out/thesis.tex", "mine");
  EXPECT_THAT(refusal([&] { make("made"); }), HasSubstr("another's"));
  EXPECT_EQ(read("out/thesis.tex"), "mine");
  EXPECT_THAT(beside(), ElementsAre("out"));
}

TEST_F(Staged, WhatComesMeanwhileIsKept) {
  make("made before");
  {
    StagedFolder folder(place(), cure, made_files);
    write(folder, "a", "made");
    folder_.write("out/thesis.tex", "mine");
    EXPECT_THAT(refusal([&] { folder.finish(); }), HasSubstr("another's"));
    EXPECT_EQ(read(folder.keep().lexically_relative(folder_.path()).string() + "/a"), "made");
  }
  EXPECT_EQ(read("out/a"), "made before");
  EXPECT_EQ(read("out/thesis.tex"), "mine");
  { const StagedFolder other(folder_.path() / "other", cure, made_files); }
  EXPECT_EQ(beside().size(), 2u);
}

TEST_F(Staged, APlantedLinkIsNotWrittenThrough) {
  folder_.write("victim", "precious");
  {
    StagedFolder folder(place(), cure, made_files);
    fs::path staging;
    for (const std::string& name : beside())
      if (!name.ends_with(".lock") && name.starts_with(".out")) staging = folder_.path() / name;
    fs::create_symlink(folder_.path() / "victim", staging / "a");
    EXPECT_THAT(refusal([&] { write(folder, "a", "made"); }), HasSubstr("File exists"));
  }
  EXPECT_EQ(read("victim"), "precious");
}

TEST_F(Staged, IsRefusedWhereItCannotBe) {
  folder_.write("file", "x");
  fs::create_symlink("nowhere", folder_.path() / "link");
  const auto refused = [](const fs::path& place) {
    return refusal([&] { const StagedFolder folder(place, cure, made_files); });
  };
  EXPECT_THAT(refused(""), HasSubstr("empty"));
  EXPECT_THAT(refused("/"), HasSubstr("root"));
  EXPECT_THAT(refused(folder_.path() / "file"), HasSubstr("is a file, not a folder; name another"));
  EXPECT_THAT(refused(folder_.path() / "file/out"), HasSubstr("Not a directory"));
  EXPECT_THAT(refused(folder_.path() / "link"), HasSubstr("leads nowhere"));
  EXPECT_THAT(refused(folder_.path() / std::string(300, 'x')), HasSubstr("too long"));
  EXPECT_THAT(beside(), ElementsAre("file", "link"));
}

TEST_F(Staged, AVeryLongNameLeavesRoomForTheStaging) {
  StagedFolder folder(folder_.path() / std::string(255, 'x'), cure, made_files);
  write(folder, "a", "made");
  EXPECT_EQ(folder.finish(), "");
  EXPECT_THAT(beside(), ElementsAre(std::string(255, 'x')));
}

TEST(StagingName, IsToldFromOthers) {
  EXPECT_TRUE(is_staging_name(".out.plumb-0123456789ab"));
  EXPECT_TRUE(is_staging_name(".out.plumb-0123456789ab.lock"));
  EXPECT_TRUE(is_staging_name(".out.plumb-0123456789ab.old"));
  for (const char* name : {"out.plumb-0123456789ab", ".out.plumb-backup",
                           ".out.plumb-0123456789abc", ".lock", "", "scan.partial-1"})
    EXPECT_FALSE(is_staging_name(name)) << name;
}

TEST(StagingJournal, ANameThatLeavesTheFolderIsNoJournal) {
  for (const char* line : {"file ../a\n", "file /a\n", "file a//b\n", "old-file 1 2 3 4 ../../a\n",
                           "folder .\n", "nonsense 1\n", "made x\n"})
    EXPECT_FALSE(StagingJournal().read(line)) << line;
  StagingJournal journal;
  EXPECT_TRUE(journal.read("made 5\nfolder frames\nfile frames/a b.pcd\nfile cut"));
  EXPECT_EQ(journal.made.inode, 5u);
  ASSERT_EQ(journal.made.files.size(), 1u);
  EXPECT_EQ(journal.made.files[0].name, "frames/a b.pcd");
}

}  // namespace
}  // namespace plumb::io
