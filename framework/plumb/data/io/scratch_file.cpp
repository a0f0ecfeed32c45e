#include "plumb/data/io/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "plumb/data/error.hpp"

namespace plumb::io {
namespace {

/// Where the file system knows no file without a name, it loses it at once.
int open_in(const std::string& folder) {
  const int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name = folder + "/plumb-XXXXXX";
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) unlink(name.c_str());
  return named;
}

}  // namespace

ScratchFile::ScratchFile() {
  const char* wanted = std::getenv("TMPDIR");
  for (const std::string folder : {wanted ? wanted : "", "/var/tmp", "/tmp"})
    if (!folder.empty() && (file_ = open_in(folder)) >= 0) return;
  throw Error(std::string("no temporary file can be made (") + std::strerror(errno) +
              "); name a folder on a disk with room in TMPDIR");
}

ScratchFile::~ScratchFile() { close(file_); }

std::uint64_t ScratchFile::append(const void* bytes, std::size_t size) {
  const std::uint64_t begin = size_.fetch_add(size);
  const auto* from = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = pwrite(file_, from + done, size - done, static_cast<off_t>(begin + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      throw Error(std::string("a temporary file cannot be written (") + std::strerror(errno) +
                  "); make room, or name a folder on a larger disk in TMPDIR");
    done += static_cast<std::size_t>(n);
  }
  return begin;
}

void ScratchFile::read(std::uint64_t at, void* to, std::size_t size) const {
  for (std::size_t done = 0; done < size;) {
    const ssize_t n =
        pread(file_, static_cast<char*>(to) + done, size - done, static_cast<off_t>(at + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      throw Error(std::string("a temporary file cannot be read back (") +
                  (n < 0 ? std::strerror(errno) : "it is shorter than what was written") + ")");
    done += static_cast<std::size_t>(n);
  }
}

}  // namespace plumb::io
