#include "plumb/data/io/regular_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "plumb/data/io/fence.hpp"
#include "plumb/data/io/file_text.hpp"

namespace plumb::io {
namespace {

std::string kind_of(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

void require_file(const std::filesystem::path& file, const std::string& other) {
  if (!other.empty()) refuse(file, "is " + other + ", not a regular file: give the path of a file");
}

}  // namespace

std::string other_than_file(const std::filesystem::path& file) {
  struct stat status;
  return stat(file.c_str(), &status) == 0 ? kind_of(status.st_mode) : "";
}

RegularFile::RegularFile(const std::filesystem::path& file, int flags, mode_t mode) : file_(file) {
  require_inside_of_fence(file);
  require_file(file, other_than_file(
                         file));  // before it is opened: to open a device may already do something
  descriptor_ = ::open(file.c_str(), flags | O_NONBLOCK | O_CLOEXEC | O_NOCTTY, mode);
  if (descriptor_ < 0)
    refuse(file, std::string("cannot be opened (") + std::strerror(errno) + "): check the path");
  struct stat status;
  const bool known = fstat(descriptor_, &status) == 0;
  if (known && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  require_file(file, known ? kind_of(status.st_mode) : "nothing that can be looked at");
}

RegularFile::~RegularFile() { ::close(descriptor_); }

std::size_t RegularFile::read(char* to, std::size_t size) {
  for (;;) {
    const ssize_t got = ::read(descriptor_, to, size);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR)
      refuse(file_, std::string("cannot be read (") + std::strerror(errno) + "): check the disk");
  }
}

}  // namespace plumb::io
