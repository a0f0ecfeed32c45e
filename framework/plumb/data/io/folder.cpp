#include "plumb/data/io/folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace plumb::io {
namespace {

constexpr int as_folder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
/// O_NONBLOCK: a pipe is told from a file without waiting for its other end.
constexpr int as_file = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

FileStamp stamp_of(const struct stat& at) {
  return {at.st_ino, static_cast<std::uint64_t>(at.st_size), nanoseconds(at.st_mtim),
          nanoseconds(at.st_ctim)};
}

std::optional<FileStamp> stamp_of(int file) {
  struct stat at {};
  if (uninterrupted([&] { return fstat(file, &at); }) != 0) return std::nullopt;
  if (!S_ISREG(at.st_mode)) return errno = EINVAL, std::nullopt;
  return stamp_of(at);
}

/// Hands on what stands in a file, at most so many bytes.
bool read_all(int file, std::uint64_t most, const Take& take) {
  std::vector<char> block(std::size_t{1} << 20);
  for (std::uint64_t left = most; left > 0;) {
    const ssize_t n = uninterrupted([&] {
      return read(file, block.data(),
                  static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size())));
    });
    if (n < 0) return false;
    if (n == 0) break;
    take({block.data(), static_cast<std::size_t>(n)});
    left -= static_cast<std::uint64_t>(n);
  }
  return true;
}

int open_in(int folder, const std::string& name, int how) {
  return uninterrupted([&] { return openat(folder, name.c_str(), how); });
}

}  // namespace

bool Handle::close() {
  const int number = std::exchange(number_, -1);
  return number < 0 || ::close(number) == 0 ||
         errno == EINTR;  // interrupted, it is closed all the same
}

Folder::Folder(const std::filesystem::path& path)
    : handle_(open_in(AT_FDCWD, path.string(), as_folder)) {}

std::uint64_t Folder::inode() const {
  struct stat at {};
  return uninterrupted([&] { return fstat(number(), &at); }) == 0 ? at.st_ino : 0;
}

Folder Folder::inner(const std::string& relative) const {
  Folder folder;
  folder.handle_ = Handle(open_in(number(), ".", as_folder));
  for (std::size_t begin = 0; folder && begin < relative.size();) {
    const std::size_t end = std::min(relative.find('/', begin), relative.size());
    folder.handle_ = Handle(
        open_in(folder.number(), relative.substr(begin, end - begin), as_folder | O_NOFOLLOW));
    begin = end + 1;
  }
  return folder;
}

std::optional<std::vector<std::string>> Folder::names() const {
  Folder again = inner("");  // a position of its own
  if (!again) return std::nullopt;
  DIR* entries = fdopendir(again.number());
  if (!entries) return std::nullopt;
  static_cast<void>(again.handle_.release());  // closedir() closes it
  std::vector<std::string> names;
  int fault = 0;
  for (;;) {
    errno = 0;
    const dirent* entry = readdir(entries);
    if (!entry && errno == EINTR) continue;
    if (!entry) {
      fault = errno;
      break;
    }
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  closedir(entries);
  if (fault != 0) return errno = fault, std::nullopt;
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<FileStamp> Folder::stamp(const std::string& name) const {
  struct stat at {};
  if (uninterrupted([&] { return fstatat(number(), name.c_str(), &at, AT_SYMLINK_NOFOLLOW); }) != 0)
    return std::nullopt;
  if (!S_ISREG(at.st_mode)) return errno = EINVAL, std::nullopt;
  return stamp_of(at);
}

std::optional<HashedFile> Folder::hashed(const std::string& name) const {
  const Handle file(open_in(number(), name, as_file));
  if (!file) return std::nullopt;
  const auto before = stamp_of(file.number());
  if (!before) return std::nullopt;
  Hasher hasher;
  if (!read_all(file.number(), before->size + 1,
                [&](std::string_view part) { hasher.bytes(part.data(), part.size()); }))
    return std::nullopt;
  if (stamp_of(file.number()) != before) return errno = EBUSY, std::nullopt;
  return HashedFile{*before, hasher.hash()};
}

std::optional<std::string> Folder::text(const std::string& name, std::size_t most) const {
  const Handle file(open_in(number(), name, as_file));
  if (!file) return std::nullopt;
  const auto stamp = stamp_of(file.number());
  if (!stamp) return std::nullopt;
  if (stamp->size > most) return errno = EFBIG, std::nullopt;
  std::string text;
  if (!read_all(file.number(), stamp->size, [&](std::string_view part) { text += part; }))
    return std::nullopt;
  return text;
}

std::optional<std::uint64_t> Folder::inode_of(const std::string& name) const {
  struct stat at {};
  if (uninterrupted([&] { return fstatat(number(), name.c_str(), &at, AT_SYMLINK_NOFOLLOW); }) != 0)
    return std::nullopt;
  return S_ISDIR(at.st_mode) ? at.st_ino : 0;
}

bool Folder::lacks(const std::string& name) const { return !inode_of(name) && errno == ENOENT; }

bool Folder::sync() const { return sync_handle(number()); }

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = uninterrupted([&] { return write(file, bytes.data(), bytes.size()); });
    if (n < 0) return false;
    if (n == 0) return errno = ENOSPC, false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

bool sync_handle(int handle) {
  return uninterrupted([&] { return fsync(handle); }) == 0 || errno == EINVAL || errno == ENOTSUP ||
         errno == EROFS;
}

}  // namespace plumb::io
