#include "plumb/store/store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstring>
#include <mutex>
#include <random>

#include "plumb/data/error.hpp"
#include "plumb/store/blob.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/index.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr const char *mark_file = "plumb-store", *mark = "plumb store 2";

constexpr std::size_t small_blob = std::size_t{8} << 20;  ///< is made whole before it is written

std::mutex fault_mutex;

std::string new_token() {
  std::random_device device;
  return std::to_string((std::uint64_t{device()} << 32) | device());
}

bool holds_more_than_marks(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (!entry.path().filename().string().starts_with(mark_file)) return true;
  return false;
}

}  // namespace

Store::Store(const fs::path& folder, StoreRole role) : folder_(fs::absolute(folder).lexically_normal()), token_(new_token()) {
  const auto refuse = [&](const std::string& why) { throw Error("--store " + folder.string() + ": " + why); };
  std::error_code error;
  const fs::path marked = folder_ / mark_file;
  if (!fs::exists(marked, error)) {
    if (role == StoreRole::worker) refuse("there is no store; a worker must see the folder of its run at the same place");
    // Another run may be making it at this moment: its mark is there before anything else is.
    if (fs::exists(folder_, error) && (!fs::is_directory(folder_) || holds_more_than_marks(folder_)) && !fs::exists(marked, error))
      refuse("holds something else and is no store; give a folder that is new or empty");
    fs::create_directories(folder_, error);
    if (!error && !replace_whole(marked, std::string(mark) + "\n"))
      if (const int why = errno; !fs::exists(marked, error)) error = {why, std::generic_category()};  // else another run was faster
  }
  if (!error) {
    std::string line(MappedFile(marked).bytes());
    line.resize(std::min(line.find('\n'), line.size()));
    if (line != mark)
      refuse("is a store of another format ('" + line.substr(0, 40) + "', this program has '" + mark + "'); give another folder");
  }
  for (const char* inner : {"blobs", "new"})
    if (!error) fs::create_directories(folder_ / inner, error);
  if (!error && access((folder_ / "new").c_str(), W_OK) != 0) error = {errno, std::generic_category()};
  if (error) refuse("cannot be written (" + error.message() + "); give another folder");
  if (role == StoreRole::driver) index_ = std::make_unique<Index>(folder_);
}

Store::~Store() { sync(); }

std::optional<StoredResult> Store::find(const Hash128& key) {
  const fs::path file = blob_file(folder_, key);
  const MappedFile mapped(file);
  if (!mapped.there()) return std::nullopt;
  auto result = read_blob(key, mapped.bytes());
  if (!result) {
    ++damaged_;
    remove(key);
  } else if (index_) {
    index_->used(key);
  }
  return result;
}

bool Store::put(const Hash128& key, const StoredResult& result, std::string_view step) {
  if (failed_) return false;
  const fs::path file = blob_file(folder_, key);
  const fs::path fresh = folder_ / "new" / (key.text() + "." + token_ + "." + std::to_string(++written_));
  std::size_t size = 0;
  const auto give = [&](const Take& take) {
    const auto counted = [&](std::string_view bytes) { size += bytes.size(), take(bytes); };
    if (size_of_blob(result) <= small_blob) counted(blob_of(key, result, step));
    else give_blob(key, result, step, counted);
  };
  if (!write_pieces(fresh, give)) return fail(std::strerror(errno));
  std::error_code error;
  fs::rename(fresh, file, error);
  if (error) {  // the first of its folder
    error.clear();
    fs::create_directories(file.parent_path(), error);
    if (!error) fs::rename(fresh, file, error);
  }
  if (!error) {
    if (index_) index_->made(key, step, size);
    return true;
  }
  const std::string why = error.message();
  fs::remove(fresh, error);
  return fail(why);
}

bool Store::contains(const Hash128& key) const {
  if (access(blob_file(folder_, key).c_str(), F_OK) != 0) return false;
  if (index_) index_->used(key);
  return true;
}

std::size_t Store::bytes_of(const Hash128& key) const {
  std::error_code error;
  const auto size = fs::file_size(blob_file(folder_, key), error);
  return error ? 0 : size;
}

void Store::note(const Hash128& key, std::string_view step, std::size_t bytes) {
  ++written_;  // sync has something to do
  if (index_) index_->made(key, step, bytes > 0 ? bytes : bytes_of(key));
}

bool Store::remove(const Hash128& key) {
  const bool removed = unlink(blob_file(folder_, key).c_str()) == 0;
  if (index_) index_->gone(key);
  return removed;
}

bool Store::fail(const std::string& why) {
  const std::lock_guard lock(fault_mutex);
  if (!failed_.exchange(true)) fault_ = why;
  return false;
}

std::string Store::fault() const {
  const std::lock_guard lock(fault_mutex);
  return fault_;
}

std::string Store::index_rebuilt() const { return index_ ? index_->rebuilt() : ""; }
std::string Store::index_fault() const { return index_ ? index_->fault() : ""; }

void Store::sync() {
  if (index_) index_->flush();
  if (written_ == 0) return;
  const int place = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (place < 0) return;
  syncfs(place);
  close(place);
}

}  // namespace plumb
