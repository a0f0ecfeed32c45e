#include "plumb/store/store.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <random>

#include "plumb/data/error.hpp"
#include "plumb/data/io/ownership.hpp"
#include "plumb/store/blob.hpp"
#include "plumb/store/blob_file.hpp"
#include "plumb/store/index.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr const char *mark_file = store_mark, *mark = "plumb store 2";

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

Store::Store(const fs::path& folder, StoreRole role, Whose whose, std::string title)
    : title_(title.empty() ? "--cache-dir " + folder.string() : std::move(title)),
      folder_(fs::absolute(folder / "").lexically_normal().parent_path()),
      whose_(whose),
      token_(new_token()) {
  std::error_code error;
  judge();
  if (!fs::exists(folder_ / mark_file, error)) {
    make_folder(role);
    judge();  // another user may have been faster
  }
  read_mark();
  require_folders();
  if (role == StoreRole::driver) index_ = std::make_unique<Index>(folder_, whose_);
}

Store::~Store() { sync(); }

void Store::refuse(const std::string& why) const { throw Error(title_ + ": " + why); }

void Store::refuse_unwritable(int why) const {
  refuse(std::string("cannot be written (") + std::strerror(why) + "); give another folder");
}

/// For this user alone, where it is not there yet; a folder that is empty stays as it is.
void Store::make_folder(StoreRole role) const {
  if (role == StoreRole::worker)
    refuse("there is no cache; a worker must see the folder of its run at the same place");
  std::error_code error;
  const fs::path marked = folder_ / mark_file;
  if (fs::is_directory(folder_, error) && access(folder_.c_str(), R_OK | W_OK | X_OK) != 0)
    refuse_unwritable(errno);  // root's, perhaps
  // Another run may be making it at this moment: its mark is there before anything else is.
  if (fs::exists(folder_, error) &&
      (!fs::is_directory(folder_) || holds_more_than_marks(folder_)) && !fs::exists(marked, error))
    refuse("holds something else and is not a cache; give a folder that is new or empty");
  fs::create_directories(folder_.parent_path(), error);
  if (error) refuse_unwritable(error.value());
  if (mkdir(folder_.c_str(), 0700) != 0 && errno != EEXIST) refuse_unwritable(errno);
  if (!replace_whole(marked, std::string(mark) + "\n"))
    if (const int why = errno; !fs::exists(marked, error))
      refuse_unwritable(why);  // else another run was faster
}

/// Refuses a folder whose results others may have written, or may write while they are used.
void Store::judge() const {
  if (whose_ == Whose::anyones) return;
  std::error_code error;
  const fs::path store = fs::weakly_canonical(folder_, error);
  if (error) refuse_unwritable(error.value());
  for (fs::path at = store;; at = at.parent_path()) {
    const bool itself = at == store;
    if (fs::is_directory(at, error))
      if (const auto loose =
              io::looseness_of(at, itself ? io::Judging::entry : io::Judging::lenient))
        refuse((itself ? "" : at.string() + " ") + loose->what +
               ", so that its results may be anybody's; " + loose->cure(itself ? "-R" : "") +
               " if they are yours, give another folder, or say --trust-cache");
    if (at == at.root_path()) return;
  }
}

void Store::read_mark() const {
  const MappedFile marked(folder_ / mark_file, whose_);
  const bool loose =
      !marked.refused().empty() && why_refused(folder_ / mark_file, Whose::anyones).empty();
  if (!marked.there())
    refuse(std::string("its file '") + mark_file + "' " +
           (marked.refused().empty() ? "cannot be read" : marked.refused()) +
           (loose ? "; chmod -R go-w '" + folder_.string() +
                        "' if it is yours, give another folder, or say --trust-cache"
                  : "; give another folder"));
  std::string line(marked.bytes().substr(0, 80));
  line.resize(std::min(line.find('\n'), line.size()));
  if (line != mark)
    refuse("is a cache of another format ('" + line.substr(0, 40) + "', this program has '" + mark +
           "'); give another folder");
}

/// Folders, and no links to others: what is removed from a store must lie in it.
void Store::require_folders() const {
  std::error_code error;
  for (const char* inner : {"blobs", "new"}) {
    const fs::path folder = folder_ / inner;
    if (mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST) refuse_unwritable(errno);
    if (!fs::is_directory(fs::symlink_status(folder, error)))
      refuse(std::string("its '") + inner + "' is not a directory of its own; give another folder");
  }
  if (fs::is_symlink(folder_ / "jobs", error))
    refuse("its 'jobs' is not a directory of its own; give another folder");
  for (fs::directory_iterator part(folder_ / "blobs", error), end; !error && part != end;
       part.increment(error))
    if (part->is_symlink())
      refuse("holds a link, " + part->path().string() +
             ", where it has folders of its own; remove it, or give another folder");
  if (access((folder_ / "new").c_str(), W_OK) != 0) refuse_unwritable(errno);
}

std::optional<StoredResult> Store::find(const Hash128& key, const FaultOf& fault_of) {
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
    return true;
  }
  const std::string why = error.message();
  fs::remove(fresh, error);
  return fail(why);
}

bool Store::contains(const Hash128& key) const {
  if (!size_of_file(blob_file(folder_, key))) return false;
  if (index_) index_->used(key);
  return true;
}

std::size_t Store::bytes_of(const Hash128& key) const {
  return size_of_file(blob_file(folder_, key)).value_or(0);
}

void Store::note(const Hash128& key, std::string_view step, std::size_t bytes) {
  ++written_;  // sync has something to do
  if (index_) index_->made(key, step, bytes > 0 ? bytes : bytes_of(key));
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
