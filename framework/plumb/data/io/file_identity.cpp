#include "plumb/data/io/file_identity.hpp"

#include <sys/stat.h>

#include <atomic>
#include <vector>

#include "plumb/data/error.hpp"
#include "plumb/data/io/regular_file.hpp"

namespace plumb::io {

void add_bytes(Hasher& hasher, const std::filesystem::path& file) {
  RegularFile in(file);
  std::vector<char> block(std::size_t{1} << 20);
  while (const std::size_t size = in.read(block.data(), block.size()))
    hasher.bytes(block.data(), size);
}

namespace {

std::atomic<FileIdentity> chosen = FileIdentity::status;

bool add_content(Hasher& hasher, const std::filesystem::path& file) {
  try {
    add_bytes(hasher, file);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

void identify_files_by(FileIdentity identity) { chosen = identity; }

bool add_identity(Hasher& hasher, const std::filesystem::path& file) {
  struct stat at {};
  if (stat(file.c_str(), &at) != 0) return false;
  if (chosen == FileIdentity::content) {
    if (S_ISDIR(at.st_mode)) return true;  // its files count one by one
    const std::int64_t size = at.st_size;
    hasher.bytes(&size, sizeof size);
    return add_content(hasher, file);
  }
  const std::int64_t facts[] = {at.st_size, at.st_mtim.tv_sec, at.st_mtim.tv_nsec};
  hasher.bytes(facts, sizeof facts);
  return true;
}

}  // namespace plumb::io
