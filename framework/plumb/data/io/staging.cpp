#include "plumb/data/io/staging.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>

namespace plumb::io {
namespace {

constexpr const char *between = ".plumb-", *marker_end = ".lock", *old_end = ".old";
constexpr std::size_t token_size = 32, token_in_name = 12;
constexpr std::size_t longest_marker = std::size_t{1} << 30;
constexpr const char* first_lines =
    "# plumb makes a folder here, or was killed while it did. The next plumb that writes to the "
    "same place removes what is listed, and this.\n";
/// Instead, where the file system knows no locks: nothing tells then whether it is in use.
constexpr const char* first_lines_unlocked =
    "# plumb makes a folder here. When no plumb runs any more, remove it and this.\n";

bool is_hexadecimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

/// What the name of a staged folder begins with; a very long place is cut, at no byte inside of a
/// letter.
std::string begin_of_names(const std::string& place) {
  constexpr std::size_t most = 200;
  std::size_t size = std::min(place.size(), most);
  while (size > 0 && size < place.size() &&
         (static_cast<unsigned char>(place[size]) & 0xC0) == 0x80)
    --size;
  return "." + place.substr(0, size) + between;
}

std::string head_of(const std::string& token, const std::string& place, bool locked) {
  return std::string(locked ? first_lines : first_lines_unlocked) + "token " + token + "\nplace " +
         hash_of(place).text() + "\n";
}

bool lock(int marker, int how) {
  return uninterrupted([&] { return flock(marker, how); }) == 0;
}

/// The marker of a program that is no more, locked; nothing for any other file.
Handle abandoned(const Folder& parent, const std::string& name) {
  Handle marker(uninterrupted([&] {
    return openat(parent.number(), name.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  }));
  struct stat at {};
  if (!marker || fstat(marker.number(), &at) != 0 || !S_ISREG(at.st_mode) ||
      at.st_uid != geteuid() || at.st_nlink != 1)
    return {};
  if (!lock(marker.number(), LOCK_EX | LOCK_NB)) return {};
  const auto still = parent.stamp(name);  // who held it until now may have removed it
  return still && still->inode == at.st_ino ? std::move(marker) : Handle();
}

void remove_abandoned(const Folder& parent, const std::string& place,
                      const std::string& marker_name) {
  const Handle marker = abandoned(parent, marker_name);
  const auto text = marker ? parent.text(marker_name, longest_marker) : std::nullopt;
  if (!text) return;
  const std::size_t at = std::string_view(first_lines).size() + std::string_view("token ").size();
  if (text->size() < at + token_size) return;
  const std::string token = text->substr(at, token_size), head = head_of(token, place, true);
  StagingJournal journal;
  journal.name = marker_name.substr(0, marker_name.size() - std::string_view(marker_end).size());
  if (!is_hexadecimal(token) || !journal.name.ends_with(between + token.substr(0, token_in_name)) ||
      !text->starts_with(head))
    return;
  if (!journal.read(std::string_view(*text).substr(head.size())) ||
      journal.remove(parent, place) != 0)
    return;
  unlinkat(parent.number(), marker_name.c_str(), 0);
}

}  // namespace

bool Staging::draw_names() {
  unsigned char bytes[token_size / 2];
  for (std::size_t drawn = 0; drawn < sizeof bytes;) {
    const ssize_t n =
        uninterrupted([&] { return getrandom(bytes + drawn, sizeof bytes - drawn, 0); });
    if (n < 0) return false;
    drawn += static_cast<std::size_t>(n);
  }
  constexpr char digits[] = "0123456789abcdef";
  token_.clear();
  for (const unsigned char byte : bytes) (token_ += digits[byte >> 4]) += digits[byte & 15];
  journal_.name = begin_of_names(place_) + token_.substr(0, token_in_name);
  return true;
}

/// The marker under its name from the beginning: where files without one are not known. A kill
/// right now leaves an empty file.
bool Staging::make_marker_by_name(const std::string& name) {
  constexpr int fresh = O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC;
  marker_ =
      Handle(uninterrupted([&] { return openat(parent_.number(), name.c_str(), fresh, 0600); }));
  named_ = static_cast<bool>(marker_);
  if (!named_) return false;
  const bool locked = lock(marker_.number(), LOCK_EX);
  return write_all(marker_.number(), head_of(token_, place_, locked));
}

/// Where it can be, the marker appears locked and with all that it must hold, so that a kill leaves
/// no half of one.
bool Staging::make_marker(const std::string& name) {
  constexpr int unknown[] = {EOPNOTSUPP, EISDIR, EINVAL, ENOENT, ENOSYS, EXDEV, EPERM};
  const auto is_unknown = [&] {
    return std::find(std::begin(unknown), std::end(unknown), errno) != std::end(unknown);
  };
  marker_ = Handle(uninterrupted(
      [&] { return openat(parent_.number(), ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600); }));
  if (!marker_) return is_unknown() && make_marker_by_name(name);
  const bool locked = lock(marker_.number(), LOCK_EX);
  if (!write_all(marker_.number(), head_of(token_, place_, locked)) ||
      !sync_handle(marker_.number()))
    return false;
  const std::string itself = "/proc/self/fd/" + std::to_string(marker_.number());
  named_ =
      uninterrupted([&] {
        return linkat(AT_FDCWD, itself.c_str(), parent_.number(), name.c_str(), AT_SYMLINK_FOLLOW);
      }) == 0;
  return named_ || (is_unknown() && make_marker_by_name(name));
}

bool Staging::make() {
  for (int tries = 0;; ++tries) {
    if (!draw_names()) return false;
    if (make_marker(journal_.name + marker_end)) break;
    if (errno != EEXIST || tries == 10) return false;
  }
  const std::string& name = journal_.name;
  if (uninterrupted([&] { return mkdirat(parent_.number(), name.c_str(), 0777); }) != 0) {
    const int why = errno;
    forget();  // what bears the name is another's
    return errno = why, false;
  }
  folder_ = parent_.inner(name);
  if (!folder_) return false;
  journal_.made.inode = folder_.inode();
  return journal_.made.inode != 0 && note("made " + std::to_string(journal_.made.inode) + "\n");
}

/// On the disk before what it is of is made, so that a power cut leaves nothing that is not listed.
bool Staging::note(const std::string& lines) {
  return write_all(marker_.number(), lines) && sync_handle(marker_.number());
}

bool Staging::add_folder(const std::string& name) {
  journal_.made.folders.push_back(name);
  if (!note(StagingJournal::line_of("folder", name))) return false;
  if (uninterrupted([&] { return mkdirat(folder_.number(), name.c_str(), 0777); }) != 0)
    return false;
  return static_cast<bool>(inner_[name] = folder_.inner(name));
}

Handle Staging::create(const std::string& name) {
  journal_.made.files.push_back({name, std::nullopt});
  if (!note(StagingJournal::line_of("file", name))) return {};
  const auto slash = name.rfind('/');
  const auto inner = slash == name.npos ? inner_.end() : inner_.find(name.substr(0, slash));
  const int folder = inner == inner_.end() ? folder_.number() : inner->second.number();
  const std::string leaf = inner == inner_.end() ? name : name.substr(slash + 1);
  constexpr int fresh = O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_CLOEXEC;
  return Handle(uninterrupted([&] { return openat(folder, leaf.c_str(), fresh, 0666); }));
}

bool Staging::sync() {
  return std::all_of(inner_.begin(), inner_.end(),
                     [](const auto& inner) { return inner.second.sync(); }) &&
         folder_.sync();
}

bool Staging::note_old(Listing old) {
  journal_.old = std::move(old);
  return note(journal_.lines_of_old());
}

int Staging::remove() {
  if (!named_) return 0;
  int fault = 0;
  for (int tries = 0; tries < 3; ++tries) {  // what failed may not fail for good
    fault = journal_.remove(parent_, place_);
    if (fault == 0) return forget() ? 0 : errno;
  }
  return fault;
}

bool Staging::forget() {
  const std::string name = journal_.name + marker_end;
  for (int tries = 0; tries < 3; ++tries)
    if (unlinkat(parent_.number(), name.c_str(), 0) == 0 || errno == ENOENT) {
      named_ = false;
      marker_.close();
      return true;
    }
  return false;
}

void remove_remains(const Folder& parent, const std::string& place) {
  const std::string begin = begin_of_names(place), end = marker_end;
  const auto names = parent.names();
  if (!names) return;
  for (const std::string& name : *names)
    if (name.size() == begin.size() + token_in_name + end.size() && name.starts_with(begin) &&
        name.ends_with(end))
      remove_abandoned(parent, place, name);
}

bool is_staging_name(const std::string& name) {
  std::string_view rest = name;
  for (const std::string_view end : {marker_end, old_end})
    if (rest.ends_with(end)) rest.remove_suffix(end.size());
  if (!rest.starts_with('.') || rest.size() < token_in_name) return false;
  const std::string_view token = rest.substr(rest.size() - token_in_name);
  rest.remove_suffix(token_in_name);
  return is_hexadecimal(token) && rest.ends_with(between);
}

}  // namespace plumb::io
