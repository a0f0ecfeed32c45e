#include "plumb/store/store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <mutex>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/store/blob.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr const char *mark_file = "plumb-store", *mark = "plumb store 1";

std::mutex fault_mutex;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

/// Writes a file whole. False, with errno, when the disk does not take it.
bool write_whole(const fs::path& file, std::string_view bytes) {
  const int to = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (to < 0) return false;
  bool good = true;
  while (good && !bytes.empty()) {
    const ssize_t n = write(to, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    good = n > 0;
    if (good) bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  const int why = errno;
  good = close(to) == 0 && good;
  if (!good) unlink(file.c_str()), errno = why;
  return good;
}

}  // namespace

Store::Store(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  const auto refuse = [&](const std::string& why) { throw Error("--store " + folder.string() + ": " + why); };
  std::error_code error;
  const fs::path marked = folder_ / mark_file;
  if (fs::exists(marked, error)) {
    std::string line = text_of(marked);
    line.resize(std::min(line.find('\n'), line.size()));
    if (line != mark)
      refuse("is a store of another format ('" + line.substr(0, 40) + "', this program has '" + mark + "'); give another folder");
  } else {
    if (fs::exists(folder_, error) && (!fs::is_directory(folder_) || !fs::is_empty(folder_)))
      refuse("holds something else and is no store; give a folder that is new or empty");
    fs::create_directories(folder_, error);
    const fs::path fresh = folder_ / (std::string(mark_file) + "." + std::to_string(getpid()));
    if (!error && write_whole(fresh, std::string(mark) + "\n")) fs::rename(fresh, marked, error);
    else if (!error) error = {errno, std::generic_category()};
  }
  for (const char* inner : {"blobs", "new"})
    if (!error) fs::create_directories(folder_ / inner, error);
  if (!error && access((folder_ / "new").c_str(), W_OK) != 0) error = {errno, std::generic_category()};
  if (error) refuse("cannot be written (" + error.message() + "); give another folder");
}

Store::~Store() { sync(); }

fs::path Store::file_of(const Hash128& key) const {
  const std::string name = key.text();
  return folder_ / "blobs" / name.substr(0, 2) / name;
}

std::optional<StoredResult> Store::find(const Hash128& key) {
  const fs::path file = file_of(key);
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  auto result = read_blob(key, text_of(file));
  if (!result) {
    ++damaged_;
    fs::remove(file, error);
  }
  return result;
}

void Store::put(const Hash128& key, const StoredResult& result) {
  if (failed_) return;
  const fs::path file = file_of(key);
  const fs::path fresh = folder_ / "new" / (key.text() + "." + std::to_string(getpid()) + "." + std::to_string(++written_));
  if (!write_whole(fresh, blob_of(key, result))) return fail(std::strerror(errno));
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (!error) fs::rename(fresh, file, error);
  if (!error) return;
  fail(error.message());
  fs::remove(fresh, error);
}

void Store::fail(const std::string& why) {
  const std::lock_guard lock(fault_mutex);
  if (!failed_.exchange(true)) fault_ = why;
}

std::string Store::fault() const {
  const std::lock_guard lock(fault_mutex);
  return fault_;
}

void Store::sync() {
  if (written_ == 0) return;
  const int place = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (place < 0) return;
  syncfs(place);
  close(place);
}

}  // namespace plumb
