#include "plumb/plugin/trusted_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

constexpr uid_t stranger = 4'000'123;

struct TrustedFile : testing::Test {
  io::TestFolder folder;
  fs::path modules = folder.path() / "modules";
  fs::path module = folder.write("modules/a.so", "no code");

  TrustedFile() {
    chmod(modules.c_str(), 0755);
    chmod(module.c_str(), 0644);
  }
  std::string refused() const {
    return io::refusal([&] { load_module(module); });
  }
};

TEST_F(TrustedFile, IsOneThatNobodyElseMayWrite) {
  EXPECT_EQ(fault_of_file(module), "");
  for (const mode_t mode : {0664, 0666, 0646}) {
    chmod(module.c_str(), mode);
    EXPECT_THAT(fault_of_file(module), StartsWith("may be written by"));
    EXPECT_THAT(
        fault_of_file(module),
        HasSubstr("so that others could put code there; chmod go-w '" + module.string() + "'"));
    EXPECT_THAT(refused(), StartsWith(module.string() + ": is not loaded: may be written by"));
  }
}

TEST_F(TrustedFile, LiesWhereNobodyElseMayWrite) {
  chmod(modules.c_str(), 0775);
  EXPECT_THAT(fault_of_file(module),
              StartsWith(modules.string() + " may be written by its group (mode 0775)"));
  EXPECT_THAT(fault_of_folder(modules), StartsWith("may be written by its group"));
  chmod(modules.c_str(), 0755);
  chmod(folder.path().c_str(), 0777);
  EXPECT_THAT(fault_of_file(module),
              StartsWith(folder.path().string() + " may be written by everybody"));
  EXPECT_THAT(fault_of_folder(modules),
              StartsWith(folder.path().string() + " may be written by everybody"));
  EXPECT_THAT(refused(), HasSubstr("is not loaded"));
  chmod(folder.path().c_str(), 01777);  // as /tmp
  EXPECT_EQ(fault_of_file(module), "");
  EXPECT_EQ(fault_of_folder(modules), "");
}

TEST_F(TrustedFile, BelongsToRootOrThisUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a file away";
  ASSERT_EQ(chown(module.c_str(), stranger, 0), 0);
  EXPECT_THAT(fault_of_file(module), StartsWith("belongs to user number 4000123"));
  ASSERT_EQ(chown(module.c_str(), 0, 0), 0);
  ASSERT_EQ(chown(modules.c_str(), stranger, 0), 0);
  EXPECT_THAT(fault_of_file(module),
              StartsWith(modules.string() + " belongs to user number 4000123"));
  EXPECT_THAT(fault_of_folder(modules), StartsWith("belongs to user number 4000123"));
}

TEST_F(TrustedFile, IsJudgedWhereALinkLeads) {
  const fs::path link = folder.path() / "link.so";
  fs::create_symlink(module, link);
  EXPECT_EQ(fault_of_file(link), "");
  chmod(module.c_str(), 0666);
  EXPECT_THAT(fault_of_file(link), StartsWith(module.string() + " may be written by everybody"));
  chmod(module.c_str(), 0644);
  fs::create_directory_symlink(modules, folder.path() / "other");
  chmod(modules.c_str(), 0777);
  EXPECT_THAT(fault_of_folder(folder.path() / "other"),
              StartsWith(modules.string() + " may be written by everybody"));
  fs::create_symlink(folder.path() / "none", folder.path() / "lost.so");
  EXPECT_THAT(fault_of_file(folder.path() / "lost.so"), StartsWith("cannot be found"));
}

TEST_F(TrustedFile, IsRegular) {
  fs::remove(module);
  mkfifo(module.c_str(), 0600);
  EXPECT_EQ(fault_of_file(module), "is a pipe, not a regular file");
  EXPECT_THAT(refused(), HasSubstr("is a pipe"));
  EXPECT_EQ(fault_of_file(modules), "is a folder, not a regular file");
  EXPECT_EQ(fault_of_file("/dev/null"), "is a device, not a regular file");
}

TEST_F(TrustedFile, IsAskedForByTheRegistryForModulesAndManifests) {
  folder.write("modules/a.json", "{}");
  const auto why = [&] {
    const auto refused = Registry::scan({modules}).refused();
    return refused.size() == 1 ? refused[0].file.string() + ": " + refused[0].why
                               : std::to_string(refused.size()) + " refused";
  };
  chmod((modules / "a.json").c_str(), 0644);
  EXPECT_THAT(why(), HasSubstr("not a manifest that can be used"));
  chmod((modules / "a.json").c_str(), 0666);
  EXPECT_THAT(why(), StartsWith(module.string() + ": its manifest " +
                                (modules / "a.json").string() + " may be written by everybody"));
  EXPECT_THAT(why(), HasSubstr("chmod go-w"));
  chmod(module.c_str(), 0660);
  EXPECT_THAT(why(), StartsWith(module.string() + ": may be written by its group"));
  chmod(modules.c_str(), 0777);
  EXPECT_THAT(why(), StartsWith(modules.string() + ": may be written by everybody"));
  chmod(modules.c_str(), 0755), chmod(module.c_str(), 0644);
  fs::remove(modules / "a.json");
  mkfifo((modules / "a.json").c_str(), 0644);
  EXPECT_THAT(why(), HasSubstr("is a pipe, not a regular file"));
}

TEST_F(TrustedFile, TheProgramsOwnFoldersMayBeWrittenByAGroup) {
  // A checkout under umask 002: build/lib holds libplumb, build/lib/plumb the modules. This
  // library's own folder is judged here.
  const fs::path own = folder_of_this_library();
  ASSERT_FALSE(own.empty());
  struct stat at {};
  ASSERT_EQ(stat(own.c_str(), &at), 0);
  if (at.st_uid != geteuid()) GTEST_SKIP() << "the library belongs to another user";
  const fs::path inner = own / ("trusted_file_test_" + std::to_string(getpid()));
  fs::create_directory(inner);
  chmod(inner.c_str(), 0755);
  chmod(own.c_str(), at.st_mode | S_IWGRP);
  EXPECT_EQ(fault_of_folder(inner), "");
  chmod(own.c_str(), at.st_mode);
  chmod(inner.c_str(), 0775);
  EXPECT_THAT(fault_of_folder(inner), StartsWith("may be written by its group"));
  fs::remove(inner);
}

}  // namespace
}  // namespace plumb
