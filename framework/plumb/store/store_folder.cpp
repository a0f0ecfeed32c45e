#include "plumb/store/store_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "plumb/data/error.hpp"
#include "plumb/data/io/ownership.hpp"
#include "plumb/store/blob_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr const char *mark_file = store_mark, *mark = "plumb store 2";

bool holds_more_than_marks(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (!entry.path().filename().string().starts_with(mark_file)) return true;
  return false;
}

class StoreFolder {
 public:
  StoreFolder(const fs::path& folder, StoreRole role, Whose whose, const std::string& title)
      : folder_(folder), role_(role), whose_(whose), title_(title) {}

  void open() const {
    std::error_code error;
    judge();
    if (!fs::exists(folder_ / mark_file, error)) {
      make();
      judge();  // another user may have been faster
    }
    read_mark();
    require_folders();
  }

 private:
  void make() const;
  void judge() const;
  void read_mark() const;
  void require_folders() const;
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_unwritable(int why) const;

  const fs::path& folder_;
  StoreRole role_;
  Whose whose_;
  const std::string& title_;
};

void StoreFolder::refuse(const std::string& why) const { throw Error(title_ + ": " + why); }

void StoreFolder::refuse_unwritable(int why) const {
  refuse(std::string("cannot be written (") + std::strerror(why) + "); give another folder");
}

/// For this user alone, where it is not there yet; a folder that is empty stays as it is.
void StoreFolder::make() const {
  if (role_ == StoreRole::worker)
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
void StoreFolder::judge() const {
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

void StoreFolder::read_mark() const {
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
void StoreFolder::require_folders() const {
  std::error_code error;
  for (const char* inner : {"blobs", "new", "runs"}) {
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

}  // namespace

void open_store_folder(const fs::path& folder, StoreRole role, Whose whose,
                       const std::string& title) {
  StoreFolder(folder, role, whose, title).open();
}

}  // namespace plumb
