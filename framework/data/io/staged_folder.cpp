#include "plumb/data/io/staged_folder.hpp"

#include <signal.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "plumb/data/error.hpp"

namespace plumb::io {
namespace {

namespace fs = std::filesystem;

constexpr const char *mark = ".partial-", *old_mark = ".old-";

struct Staged {
  std::mutex mutex;
  std::set<fs::path> folders;
};
Staged& staged() {
  static Staged all;
  return all;
}

/// Folders beside the place with a mark and the number of a process that is no more.
std::vector<fs::path> left_behind(const fs::path& place, const char* after) {
  const std::string first = place.filename().string() + after;
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(place.parent_path(), error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(first)) continue;
    int process = 0;
    const auto [stop, fault] = std::from_chars(name.data() + first.size(), name.data() + name.size(), process);
    const bool whole = fault == std::errc() && stop == name.data() + name.size() && process > 0;
    // One with our own number is of an earlier process, too.
    if (whole && (process == getpid() || (kill(process, 0) != 0 && errno == ESRCH))) left.push_back(entry->path());
  }
  return left;
}

void mend(const fs::path& place) {
  std::error_code ignored;
  for (const fs::path& folder : left_behind(place, mark)) fs::remove_all(folder, ignored);
  for (const fs::path& folder : left_behind(place, old_mark))
    if (fs::exists(place, ignored)) fs::remove_all(folder, ignored);
    else fs::rename(folder, place, ignored);
}

/// Away at once for whoever still writes to it, then file by file.
void remove_staging(const fs::path& folder) {
  std::error_code error;
  const fs::path gone = folder.string() + "-gone";
  fs::rename(folder, gone, error);
  for (int attempt = 0; attempt < 20; ++attempt) {
    fs::remove_all(error ? folder : gone, error);
    if (!error) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

fs::path settled(const fs::path& given, const std::string& cure) {
  if (given.empty()) throw Error("the name of the folder for the results is empty; " + cure);
  fs::path place = fs::absolute(given).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  std::error_code error;
  if (fs::is_symlink(place, error)) {
    const fs::path target = fs::canonical(place, error);
    if (error) throw Error(given.string() + ": is a link that leads nowhere; " + cure);
    place = target;
  }
  if (fs::exists(place, error) && !fs::is_directory(place)) throw Error(given.string() + ": is a file, not a folder; " + cure);
  return place;
}

}  // namespace

StagedFolder::StagedFolder(const fs::path& place, std::string cure) : place_(settled(place, cure)), cure_(std::move(cure)) {
  std::error_code error;
  fs::create_directories(place_.parent_path(), error);
  const fs::path beside = place_.string() + mark + std::to_string(getpid());
  if (!error) mend(place_);
  if (!error) fs::create_directory(beside, error);
  if (error) throw Error(place_.string() + ": cannot be written (" + error.message() + "); " + cure_);
  staging_ = beside;
  const std::lock_guard lock(staged().mutex);
  staged().folders.insert(staging_);
}

StagedFolder::~StagedFolder() {
  if (staging_.empty()) return;
  const std::lock_guard lock(staged().mutex);
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  staged().folders.erase(staging_);
}

fs::path StagedFolder::keep() {
  const std::lock_guard lock(staged().mutex);
  const fs::path kept = place_.string() + ".kept-" + std::to_string(getpid());
  std::error_code error;
  fs::rename(staging_, kept, error);
  staged().folders.erase(staging_);
  return error ? std::exchange(staging_, {}) : (staging_.clear(), kept);
}

void StagedFolder::finish() {
  const std::lock_guard lock(staged().mutex);  // an interruption waits until the swap is done
  const fs::path old = place_.string() + old_mark + std::to_string(getpid());
  std::error_code error;
  const bool replaces = fs::exists(place_);
  if (replaces) fs::rename(place_, old, error);
  if (!error) {
    fs::rename(staging_, place_, error);
    std::error_code ignored;
    if (error && replaces) fs::rename(old, place_, ignored);
  }
  if (error) throw Error(place_.string() + ": cannot be replaced (" + error.message() + "); " + cure_);
  staged().folders.erase(staging_);
  staging_.clear();
  if (replaces) fs::remove_all(old, error);
}

void remove_all_staging() {
  staged().mutex.lock();  // for good
  for (const fs::path& folder : staged().folders) remove_staging(folder);
}

}  // namespace plumb::io
