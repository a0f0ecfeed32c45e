#include "plumb/store/holds.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <vector>

namespace plumb {
namespace fs = std::filesystem;
namespace {

static_assert(sizeof(Hash128) == 16);

/// Locks an open file at once, or not.
bool locked(int file, int how) {
  int done;
  do done = flock(file, how | LOCK_NB);
  while (done != 0 && errno == EINTR);
  return done == 0;
}

/// Of a file that runs may have made; -1 when it is gone, or something else.
int opened(const fs::path& file) {
  const int from = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  struct stat at {};
  if (from < 0 || (fstat(from, &at) == 0 && S_ISREG(at.st_mode))) return from;
  close(from);
  errno = ENOENT;
  return -1;
}

/// Whether the run that made the file is gone. Then nobody needs the file any more.
bool removed_as_dead(const fs::path& file, int from) {
  if (!locked(from, LOCK_SH)) return false;
  unlink(file.c_str());
  return true;
}

void remove_dead(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error))
    if (const int from = opened(file->path()); from >= 0) {
      removed_as_dead(file->path(), from);
      close(from);
    }
}

}  // namespace

Holds::Holds(const fs::path& store, const std::string& token)
    : folder_(store / "runs"), token_(token) {}

Holds::~Holds() {
  if (to_ < 0) return;
  unlink(file_.c_str());
  close(to_);
}

bool Holds::has(const Hash128& key) const {
  const std::lock_guard lock(mutex_);
  return keys_.contains(key);
}

HeldElsewhere Holds::elsewhere() const { return HeldElsewhere(folder_, file()); }

bool Holds::unless_held(const Hash128& key, const std::function<void()>& action) const {
  const std::lock_guard lock(mutex_);
  if (keys_.contains(key)) return false;
  action();
  return true;
}

fs::path Holds::file() const {
  const std::lock_guard lock(mutex_);
  return file_;
}

void Holds::add(std::span<const Hash128> keys) {
  const std::lock_guard lock(mutex_);
  std::vector<Hash128> fresh;
  for (const Hash128& key : keys)
    if (keys_.insert(key).second) fresh.push_back(key);
  if (fresh.empty()) return;
  if (!begun_) begin();
  tell(fresh);
}

/// A file that was just made has no lock for a moment, in which another run takes it for a dead
/// one's: then the next name serves.
void Holds::begin() {
  begun_ = true;
  remove_dead(folder_);
  for (int attempt = 0; attempt < 3; ++attempt) {
    file_ = folder_ / (token_ + "." + std::to_string(attempt));
    const int to = open(file_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (to < 0) return;
    struct stat at {};
    if (locked(to, LOCK_EX) && fstat(to, &at) == 0 && at.st_nlink > 0) {
      to_ = to;
      return;
    }
    unlink(file_.c_str());
    close(to);
  }
}

/// A file that is not whole is cut to a size that whole keys do not have: its run needs more than
/// stands there.
void Holds::tell(std::span<const Hash128> keys) {
  if (to_ < 0 || !whole_) return;
  const char* bytes = reinterpret_cast<const char*>(keys.data());
  std::size_t left = keys.size_bytes();
  while (left > 0) {
    const ssize_t n = write(to_, bytes, left);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    bytes += n, left -= static_cast<std::size_t>(n);
  }
  whole_ = left == 0;
  if (!whole_ && ftruncate(to_, 1) != 0) unlink(file_.c_str());
}

HeldElsewhere::HeldElsewhere(fs::path folder, fs::path own)
    : folder_(std::move(folder)), own_(std::move(own)) {}

HeldElsewhere::~HeldElsewhere() {
  for (const auto& [name, file] : files_) close(file);
}

bool HeldElsewhere::has(const Hash128& key) {
  if (!unsure_ && !keys_.contains(key)) look();
  return unsure_ || keys_.contains(key);
}

void HeldElsewhere::look() {
  std::error_code error;
  for (fs::directory_iterator file(folder_, error), end; !error && file != end;
       file.increment(error))
    if (file->path() != own_ && !files_.contains(file->path().filename().string()))
      take(file->path());
  unsure_ |= static_cast<bool>(error);
  for (const auto& [name, file] : files_) unsure_ |= !read_on(file);
}

void HeldElsewhere::take(const fs::path& file) {
  const int from = opened(file);
  if (from < 0)
    unsure_ |= errno != ENOENT && errno != ELOOP && errno != ENXIO;  // no link, no socket
  else if (removed_as_dead(file, from))
    close(from);
  else
    files_[file.filename().string()] = from;
}

/// False when the file cannot be read, or does not hold all that its run needs.
bool HeldElsewhere::read_on(int file) {
  struct stat at {};
  if (fstat(file, &at) != 0 || at.st_size % static_cast<off_t>(sizeof(Hash128)) != 0) return false;
  std::array<Hash128, 1024> keys;
  for (;;) {
    const ssize_t n = read(file, keys.data(), sizeof keys);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n == 0;
    const auto bytes = static_cast<std::size_t>(n);
    if (bytes % sizeof(Hash128) != 0) return false;
    keys_.insert(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(bytes / sizeof(Hash128)));
  }
}

}  // namespace plumb
