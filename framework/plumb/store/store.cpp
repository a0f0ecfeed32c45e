#include "plumb/store/store.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <random>

#include "plumb/store/blob.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/holds.hpp"
#include "plumb/store/index.hpp"
#include "plumb/store/store_folder.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t small_blob = std::size_t{8} << 20;  ///< is made whole before it is written

std::mutex fault_mutex;

std::string new_token() {
  std::random_device device;
  return std::to_string((std::uint64_t{device()} << 32) | device());
}

}  // namespace

Store::Store(const fs::path& folder, StoreRole role, Whose whose, const std::string& title)
    : folder_(fs::absolute(folder / "").lexically_normal().parent_path()),
      whose_(whose),
      token_(new_token()) {
  open_store_folder(folder_, role, whose_,
                    title.empty() ? "--cache-dir " + folder.string() : title);
  if (role == StoreRole::worker) return;
  index_ = std::make_unique<Index>(folder_, whose_);
  holds_ = std::make_unique<Holds>(folder_, token_);
}

Store::~Store() { sync(); }

void Store::hold(std::span<const Hash128> keys) const {
  if (holds_) holds_->add(keys);
}

std::optional<StoredResult> Store::find(const Hash128& key, const FaultOf& fault_of) {
  hold({&key, 1});
  const fs::path file = blob_file(folder_, key);
  const MappedFile mapped(file, whose_);
  if (!mapped.refused().empty()) damage(key, mapped.refused());
  if (!mapped.there()) return std::nullopt;
  std::string why;
  auto result = read_blob(key, mapped.bytes(), &why);
  if (result && fault_of) why = fault_of(*result);
  if (!why.empty()) {
    damage(key, why);
    return std::nullopt;
  }
  if (index_) index_->used(key);
  return result;
}

void Store::damage(const Hash128& key, const std::string& why) {
  ++damaged_;
  remove(key);
  const std::lock_guard lock(fault_mutex);
  if (damage_.empty()) damage_ = key.text() + " " + why;
}

std::string Store::damage() const {
  const std::lock_guard lock(fault_mutex);
  return damage_;
}

bool Store::put(const Hash128& key, const StoredResult& result, std::string_view step) {
  if (failed_) return false;
  hold({&key, 1});
  const fs::path file = blob_file(folder_, key);
  const fs::path fresh =
      folder_ / "new" / (key.text() + "." + token_ + "." + std::to_string(++written_));
  std::size_t size = 0;
  const auto give = [&](const Take& take) {
    const auto counted = [&](std::string_view bytes) { size += bytes.size(), take(bytes); };
    if (size_of_blob(result) <= small_blob)
      counted(blob_of(key, result, step));
    else
      give_blob(key, result, step, counted);
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
    kept_bytes_ += size;
    return true;
  }
  const std::string why = error.message();
  fs::remove(fresh, error);
  return fail(why);
}

bool Store::contains(const Hash128& key) const {
  hold({&key, 1});
  if (!size_of_file(blob_file(folder_, key))) return false;
  if (index_) index_->used(key);
  return true;
}

std::size_t Store::bytes_of(const Hash128& key) const {
  return size_of_file(blob_file(folder_, key)).value_or(0);
}

void Store::note(const Hash128& key, std::string_view step, std::size_t bytes) {
  hold({&key, 1});
  ++written_;  // sync has something to do
  if (bytes == 0) bytes = bytes_of(key);
  if (index_) index_->made(key, step, bytes);
  kept_bytes_ += bytes;
}

bool Store::remove(const Hash128& key) {
  const fs::path file = blob_file(folder_, key);
  std::error_code error;
  const bool removed =
      unlink(file.c_str()) == 0 || fs::remove(file, error);  // an empty folder, too
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
