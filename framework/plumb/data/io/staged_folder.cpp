#include "plumb/data/io/staged_folder.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

namespace plumb::io {
namespace {

namespace fs = std::filesystem;

/// What this process has staged. Whoever makes or removes a name holds the lock.
struct Staged {
  std::mutex mutex;
  std::set<StagedFolder*> folders;
  std::vector<fs::path> parents;  ///< made for them, outer ones first
};
Staged& staged() {
  static auto* all =
      new Staged;  // never destroyed: the thread that waits for signals outlives main()
  return *all;
}

void remove_empty_parents() {
  std::vector<fs::path>& parents = staged().parents;
  for (std::size_t k = parents.size(); k-- > 0;)
    if (uninterrupted([&] { return rmdir(parents[k].c_str()); }) == 0)
      parents.erase(parents.begin() + static_cast<std::ptrdiff_t>(k));
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
  if (!place.has_filename()) throw Error(given.string() + ": is the root of all folders; " + cure);
  return place;
}

/// Throws Error: what replaces a folder must be able to remove its files.
void require_writable(const Folder& folder, const fs::path& place) {
  if (uninterrupted([&] { return faccessat(folder.number(), ".", W_OK | X_OK, AT_EACCESS); }) == 0)
    return;
  throw Error(place.string() + ": an earlier run in it cannot be removed (" + std::strerror(errno) +
              "); make the folder writable (chmod u+w), or give another one");
}

}  // namespace

std::string StagedFolder::sentence(const std::string& what, int why) const {
  return place_.string() + ": " + what + " (" + std::strerror(why) + "); " +
         (why == ENOSPC || why == EDQUOT ? "make room, or " : "") + cure_;
}

void StagedFolder::refuse(const std::string& what, int why) const {
  throw Error(sentence(what, why));
}

void StagedFolder::fail(const std::string& what, int why) const {
  throw WriteError(sentence(what, why));
}

StagedFolder::StagedFolder(const fs::path& place, std::string cure, Proof proof)
    : place_(settled(place, cure)),
      cure_(std::move(cure)),
      name_(place_.filename().string()),
      proof_(std::move(proof)) {
  {
    const std::lock_guard lock(staged().mutex);
    make_parents();
    parent_ = Folder(place_.parent_path());
    if (!parent_) refuse("cannot be written", errno);
    remove_remains(parent_, name_);
  }
  const auto give_up = [this] {
    if (staging_) staging_->remove();
    remove_empty_parents();
  };
  try {
    old_ = look();
  } catch (...) {
    const std::lock_guard lock(staged().mutex);
    give_up();
    throw;
  }
  const std::lock_guard lock(staged().mutex);
  staging_.emplace(parent_, name_);
  if (!staging_->make()) {
    const int why = errno;
    give_up();
    refuse("cannot be written", why);
  }
  staged().folders.insert(this);
}

StagedFolder::~StagedFolder() {
  const std::lock_guard lock(staged().mutex);
  staging_->remove();
  staged().folders.erase(this);
  remove_empty_parents();
}

void StagedFolder::make_parents() {
  std::vector<fs::path> missing;
  for (fs::path folder = place_.parent_path(); !Folder(folder); folder = folder.parent_path()) {
    if (errno != ENOENT || folder == folder.parent_path()) refuse("cannot be written", errno);
    missing.push_back(folder);
  }
  for (auto folder = missing.rbegin(); folder != missing.rend(); ++folder) {
    const bool made = uninterrupted([&] { return mkdir(folder->c_str(), 0777); }) == 0;
    const int why = errno;
    if (made) staged().parents.push_back(*folder);
    if (made || why == EEXIST) continue;
    remove_empty_parents();
    refuse("cannot be written", why);
  }
}

std::optional<Listing> StagedFolder::look() const {
  const auto inode = parent_.inode_of(name_);
  if (!inode && errno == ENOENT) return std::nullopt;
  if (!inode) refuse("cannot be looked at", errno);
  if (*inode == 0) throw Error(place_.string() + ": is a file, not a folder; " + cure_);
  const Folder folder = parent_.inner(name_);
  if (!folder) refuse("cannot be looked at", errno);
  Listing listing = proof_(folder, place_);
  listing.inode = folder.inode();
  if (!listing.files.empty()) require_writable(folder, place_);
  return listing;
}

bool StagedFolder::is_unchanged() const {
  if (!old_) return parent_.lacks(name_);
  const Folder folder = parent_.inner(name_);
  return folder && is_as_listed(folder, *old_);
}

void StagedFolder::look_again() {
  if (!is_unchanged()) old_ = look();
}

void StagedFolder::add_folder(const std::string& name) {
  const std::lock_guard lock(staged().mutex);
  if (!staging_->add_folder(name)) fail("the folder '" + name + "' cannot be made in it", errno);
}

void StagedFolder::write(const std::string& name,
                         const std::function<void(const Take& take)>& give) {
  Handle file;
  int why = 0;
  {
    const std::lock_guard lock(staged().mutex);
    file = staging_->create(name);
    if (!file) why = errno;
  }
  const auto note = [&](bool good) {
    if (!good && why == 0) why = errno != 0 ? errno : EIO;
  };
  if (why == 0)
    give([&](std::string_view bytes) {
      if (why == 0) note(write_all(file.number(), bytes));
    });
  if (why == 0) note(sync_handle(file.number()));
  note(file.close());
  if (why != 0) fail("'" + name + "' cannot be written", why);
}

/// False: something came to the place, or went from there, since it was looked at.
bool StagedFolder::swap() {
  const std::string& made = staging_->journal().name;
  if (!old_) {
    if (move_to_new(parent_, made, name_)) return true;
    if (errno == EEXIST || errno == ENOTEMPTY) return false;
    fail("cannot be put into place", errno);
  }
  if (!staging_->note_old(*old_)) fail("cannot be replaced", errno);
  const auto rename = [&](const std::string& from, const std::string& to, unsigned how) {
    return uninterrupted([&] {
             return renameat2(parent_.number(), from.c_str(), parent_.number(), to.c_str(), how);
           }) == 0;
  };
  if (rename(made, name_, RENAME_EXCHANGE)) return true;
  if (errno != EINVAL && errno != ENOSYS && errno != ENOTSUP) fail("cannot be replaced", errno);
  const std::string old_name = staging_->journal().old_name();
  if (!move_to_new(parent_, name_, old_name)) fail("cannot be replaced", errno);
  if (move_to_new(parent_, made, name_)) return true;
  const int why = errno;
  for (int tries = 0; tries < 3 && !move_to_new(parent_, old_name, name_); ++tries) {
  }
  fail("cannot be replaced", why);
}

fs::path StagedFolder::kept_name(const std::string& of) {
  const std::string kept = name_ + ".kept-" + staging_->token().substr(0, 12);
  const fs::path folder = place_.parent_path();
  return move_to_new(parent_, of, kept) ? folder / kept : folder / of;
}

/// The disk has it, and what was there before is gone, but for what others put into it.
std::string StagedFolder::settle() {
  std::string said;
  const auto say = [&](const std::string& sentence) {
    said += (said.empty() ? place_.string() + ": is in place, but " : "; and ") + sentence;
  };
  bool synced = parent_.sync();
  for (const fs::path& made : staged().parents)
    synced = Folder(made.parent_path()).sync() && synced;
  if (!synced)
    say("the disk did not confirm it (" + std::string(std::strerror(errno)) +
        "): it may be gone after a power failure; look at the disk");
  const StagingJournal journal = staging_->journal();
  const int fault = staging_->remove();
  if (fault == 0) return said;
  const bool by_old_name = !parent_.lacks(journal.old_name());
  const std::string left = by_old_name ? journal.old_name() : journal.name;
  if (fault == ENOTEMPTY || fault == EEXIST) {
    const fs::path kept = kept_name(left);
    staging_->forget();
    say("what came into the folder before it meanwhile is kept in " + kept.string());
  } else {
    say("what was there before could not be removed (" + std::string(std::strerror(fault)) +
        ") from " + (place_.parent_path() / left).string() +
        "; the next run into the same folder tries again");
  }
  return said;
}

std::string StagedFolder::finish() {
  for (int tries = 0; tries < 5; ++tries) {
    look_again();
    const std::lock_guard lock(staged().mutex);  // an interruption waits until the swap is done
    if (!staging_->sync()) fail("cannot be written", errno);
    if (!is_unchanged() || !swap()) continue;
    return settle();
  }
  throw WriteError(place_.string() + ": is changed by others all the time; " + cure_);
}

fs::path StagedFolder::keep() {
  const std::lock_guard lock(staged().mutex);
  const fs::path kept = kept_name(staging_->journal().name);
  staging_->forget();
  return kept;
}

void remove_all_staging() {
  staged().mutex.lock();  // for good
  for (StagedFolder* folder : staged().folders) folder->staging_->remove();
  remove_empty_parents();
}

}  // namespace plumb::io
