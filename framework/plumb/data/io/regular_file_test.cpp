#include "plumb/data/io/regular_file.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "plumb/data/io/file_testing.hpp"
#include "plumb/data/io/file_text.hpp"

namespace plumb::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

struct RegularFiles : testing::Test {
  TestFolder folder;
  fs::path pipe() const {
    const fs::path name = folder.path() / "pipe";
    mkfifo(name.c_str(), 0600);
    return name;
  }
  fs::path socket() const {
    const fs::path name = folder.path() / "socket";
    const int number = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, name.c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(number, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(number);
    return name;
  }
  /// Opened in each of the ways that readers and writers open.
  static std::string refused(const fs::path& file) {
    const std::string to_read = refusal([&] { RegularFile{file}; });
    EXPECT_EQ(refusal([&] { RegularFile(file, O_WRONLY); }), to_read);
    EXPECT_EQ(refusal([&] { RegularFile(file, O_RDWR | O_CREAT); }), to_read);
    EXPECT_EQ(refusal([&] { FileBytes{file}; }), to_read);
    EXPECT_THAT(to_read, StartsWith(file.string() + ": is " + other_than_file(file) +
                                    ", not a regular file"));
    return to_read;
  }
};

TEST_F(RegularFiles, AreReadToTheirEnd) {
  RegularFile file(folder.write("text", "some bytes"));
  EXPECT_EQ(file.size(), 10u);
  char to[4];
  EXPECT_EQ(file.read(to, 4) + file.read(to, 4), 8u);
  EXPECT_EQ(file.read(to, 4), 2u);
  EXPECT_EQ(file.read(to, 4), 0u);
  EXPECT_EQ(other_than_file(folder.path() / "text"), "");
}

TEST_F(RegularFiles, AreAskedForWhereSomethingElseStands) {
  EXPECT_THAT(refused(pipe()),
              HasSubstr("is a pipe"));  // nobody writes to it: to open it would wait for ever
  EXPECT_THAT(refused(socket()), HasSubstr("is a socket"));
  EXPECT_THAT(refused(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refused("/dev/zero"), HasSubstr("is a device"));
}

TEST_F(RegularFiles, AreAskedForBehindLinksToo) {
  fs::create_symlink(pipe(), folder.path() / "link");
  EXPECT_THAT(refused(folder.path() / "link"), HasSubstr("is a pipe"));
  fs::create_symlink(folder.write("text", "ab"), folder.path() / "good");
  EXPECT_EQ(RegularFile(folder.path() / "good").size(), 2u);
}

TEST_F(RegularFiles, ThatAreMissingAreSaidToBeSo) {
  const fs::path none = folder.path() / "none";
  EXPECT_EQ(other_than_file(none), "");
  EXPECT_EQ(refusal([&] { RegularFile{none}; }),
            none.string() + ": cannot be opened (No such file or directory): check the path");
}

TEST_F(RegularFiles, AreNotTakenIntoMemoryWhenTheyAreTooLarge) {
  const fs::path file = folder.write("text", std::string((1 << 20) + 1, 'a'));
  EXPECT_EQ(
      refusal([&] { FileBytes(file, 1 << 20, "list"); }),
      file.string() + ": has 1048577 bytes, and no list is larger than 1 MiB: check the path");
  EXPECT_EQ(FileBytes(file, 2 << 20, "list").view().size(), 1048577u);
  fs::resize_file(file, std::uintmax_t{1} << 42);  // a hole: it takes no disk
  EXPECT_THAT(refusal([&] { FileBytes{file}; }),
              HasSubstr("more than this machine's memory holds"));
}

}  // namespace
}  // namespace plumb::io
