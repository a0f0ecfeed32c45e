#include "plumb/store/blob_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <vector>

namespace plumb {
namespace fs = std::filesystem;
namespace {

std::optional<Hash128> key_of(const std::string& name) {
  if (name.size() != 32) return std::nullopt;
  Hash128 key;
  const auto part = [&](std::size_t at, std::uint64_t& to) {
    return std::from_chars(&name[at], &name[at] + 16, to, 16).ptr == &name[at] + 16;
  };
  if (!part(0, key.high) || !part(16, key.low) || key.text() != name) return std::nullopt;
  return key;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

/// What stands in a file, or the names in a folder, to the disk.
bool sync_path(const fs::path& path) {
  const int place = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (place < 0) return false;
  int done;
  do done = fsync(place);
  while (done != 0 && errno == EINTR);
  const int why = errno;
  close(place), errno = why;
  return done == 0 || why == EINVAL ||
         why == ENOTSUP;  // a file system that knows no such thing for folders
}

bool is_own(const struct stat& at) {
  return (at.st_uid == geteuid() || at.st_uid == 0) && !(at.st_mode & (S_IWGRP | S_IWOTH));
}

/// Opens what is a regular file itself, and never waits: a pipe may have nobody at its other end.
/// -1 when there is none, when it cannot be read, and, with the reason, when it is refused.
int open_regular(const fs::path& file, Whose whose, struct stat& at, std::string& refused) {
  const int from = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (from < 0) {
    if (errno == ELOOP || errno == ENXIO) refused = "is not a regular file";  // a link, a socket
    return from;
  }
  if (fstat(from, &at) != 0 || !S_ISREG(at.st_mode))
    refused = "is not a regular file";
  else if (whose == Whose::own && !is_own(at))
    refused = "belongs to another user, or may be written by others";
  if (refused.empty()) return from;
  close(from);
  return -1;
}

}  // namespace

fs::path blob_file(const fs::path& store, const Hash128& key) {
  const std::string name = key.text();
  return store / "blobs" / name.substr(0, 2) / name;
}

void for_each_blob(const fs::path& store,
                   const std::function<void(const Hash128&, const fs::path&)>& visit) {
  std::error_code error;
  for (fs::directory_iterator part(store / "blobs", error), end; !error && part != end;
       part.increment(error)) {
    std::error_code gone;  // a folder that is not a directory, or went away
    if (part->is_symlink(gone)) continue;
    for (fs::directory_iterator file(part->path(), gone); !gone && file != end;
         file.increment(gone))
      if (const auto key = key_of(file->path().filename().string())) visit(*key, file->path());
  }
}

std::string why_refused(const fs::path& file, Whose whose) {
  struct stat at {};
  std::string refused;
  if (const int from = open_regular(file, whose, at, refused); from >= 0) close(from);
  return refused;
}

std::optional<std::uint64_t> size_of_file(const fs::path& file) {
  struct stat at {};
  if (lstat(file.c_str(), &at) != 0 || !S_ISREG(at.st_mode)) return std::nullopt;
  return static_cast<std::uint64_t>(at.st_size);
}

std::optional<BlobHead> head_in(const fs::path& file, const Hash128& key) {
  struct stat at {};
  std::string refused;
  const int from = open_regular(file, Whose::anyones, at, refused);
  if (from < 0) return std::nullopt;
  std::array<char, blob_head_size> bytes;
  const ssize_t n = read(from, bytes.data(), bytes.size());
  close(from);
  return n > 0 ? read_head(key, {bytes.data(), static_cast<std::size_t>(n)}) : std::nullopt;
}

bool write_whole(const fs::path& file, std::string_view bytes) {
  return write_pieces(file, [&](const Take& take) { take(bytes); });
}

bool write_pieces(const fs::path& file, const std::function<void(const Take& take)>& give) {
  const int to = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (to < 0) return false;
  bool good = true;
  int why = 0;
  give([&](std::string_view bytes) {
    while (good && !bytes.empty()) {
      const ssize_t n = write(to, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      good = n > 0;
      if (good)
        bytes.remove_prefix(static_cast<std::size_t>(n));
      else
        why = errno;
    }
  });
  if (close(to) != 0 && good) good = false, why = errno;
  if (!good) unlink(file.c_str()), errno = why;
  return good;
}

bool replace_whole(const fs::path& file, std::string_view bytes) {
  const fs::path fresh = file.string() + "." + std::to_string(getpid());
  unlink(fresh.c_str());
  if (!write_whole(fresh, bytes)) return false;
  if (sync_path(fresh) && rename(fresh.c_str(), file.c_str()) == 0)
    return sync_path(file.parent_path());
  const int why = errno;
  unlink(fresh.c_str()), errno = why;
  return false;
}

void remove_unfinished(const fs::path& store) {
  std::error_code error;
  if (fs::exists(store / "jobs", error) && !fs::is_empty(store / "jobs", error)) return;
  std::vector<fs::path> left;
  for (fs::directory_iterator file(store / "new", error), end; !error && file != end;
       file.increment(error))
    left.push_back(file->path());
  for (fs::directory_iterator file(store, error), end; !error && file != end; file.increment(error))
    for (const char* replaced : {"plumb-store.", "index.sum."}) {
      const std::string name = file->path().filename().string();
      if (name.starts_with(replaced) && is_number(name.substr(std::strlen(replaced))))
        left.push_back(file->path());
    }
  for (const fs::path& file : left) unlink(file.c_str());
}

MappedFile::MappedFile(const fs::path& file, Whose whose) {
  struct stat at {};
  const int from = open_regular(file, whose, at, refused_);
  if (from < 0) return;
  there_ = true;
  size_ = static_cast<std::size_t>(at.st_size);
  if (size_ > 0) {
    begin_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, from,
                  0);  // all of it is read twice, at once
    if (begin_ == MAP_FAILED)
      begin_ = nullptr, size_ = 0, there_ = false;
    else
      madvise(begin_, size_, MADV_SEQUENTIAL);
  }
  close(from);
}

MappedFile::~MappedFile() {
  if (begin_) munmap(begin_, size_);
}

}  // namespace plumb
