#include "plumb/data/io/staging_journal.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace plumb::io {
namespace {

/// "frames/000000.pcd" to {"frames", "000000.pcd"}.
std::pair<std::string, std::string> parted(const std::string& name) {
  const auto slash = name.rfind('/');
  return slash == name.npos ? std::pair(std::string(), name)
                            : std::pair(name.substr(0, slash), name.substr(slash + 1));
}

/// Whether a name stays in the folder.
bool is_inside(const std::string& name) {
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    const std::string part = name.substr(begin, end - begin);
    if (part.empty() || part == "." || part == "..") return false;
    begin = end + 1;
  }
  return true;
}

/// Takes what was noted first of several faults.
void note_fault(int& fault, bool good) {
  if (!good && fault == 0 && errno != ENOENT) fault = errno;
}

int remove_file(const Folder& folder, const std::string& name,
                const std::optional<FileStamp>& expected) {
  const auto stamp = folder.stamp(name);
  if (!stamp) return errno == EINVAL ? 0 : errno;  // no file of ours: its folder will not be empty
  if (expected && *stamp != *expected) return 0;
  return uninterrupted([&] { return unlinkat(folder.number(), name.c_str(), 0); }) == 0 ? 0 : errno;
}

bool remove_folder(const Folder& parent, const std::string& name) {
  return uninterrupted([&] { return unlinkat(parent.number(), name.c_str(), AT_REMOVEDIR); }) == 0;
}

int remove_listed(const Folder& parent, const std::string& name, const Listing& listing) {
  const Folder folder = parent.inner(name);
  if (!folder) return errno;
  int fault = 0;
  std::string open_name;
  Folder open_folder = folder.inner("");
  for (const ListedFile& file : listing.files) {
    const auto [in, leaf] = parted(file.name);
    if (in != open_name) open_folder = folder.inner(in), open_name = in;
    if (open_folder) errno = remove_file(open_folder, leaf, file.stamp);
    note_fault(fault, open_folder && errno == 0);
  }
  for (auto inner = listing.folders.rbegin(); inner != listing.folders.rend(); ++inner) {
    const auto [in, leaf] = parted(*inner);
    note_fault(fault, remove_folder(folder.inner(in), leaf));
  }
  note_fault(fault, remove_folder(parent, name));
  return fault;
}

}  // namespace

bool is_as_listed(const Folder& folder, const Listing& listing) {
  if (folder.inode() != listing.inode) return false;
  std::map<std::string, std::set<std::string>> expected{{"", {}}};  // names by folder
  for (const std::string& inner : listing.folders) {
    expected[inner];
    expected[parted(inner).first].insert(parted(inner).second);
  }
  for (const ListedFile& file : listing.files)
    expected[parted(file.name).first].insert(parted(file.name).second);
  for (const auto& [inner, names] : expected) {
    const Folder at = folder.inner(inner);
    const auto there = at ? at.names() : std::nullopt;
    if (!there || !std::equal(there->begin(), there->end(), names.begin(), names.end()))
      return false;
  }
  for (const ListedFile& file : listing.files) {
    const auto [in, leaf] = parted(file.name);
    if (folder.inner(in).stamp(leaf) != file.stamp) return false;
  }
  return true;
}

std::string StagingJournal::lines_of_old() const {
  std::ostringstream lines;
  lines << "old " << old.inode << '\n';
  for (const ListedFile& file : old.files) {
    const FileStamp stamp = file.stamp.value_or(FileStamp());
    lines << "old-file " << stamp.inode << ' ' << stamp.size << ' ' << stamp.changed << ' '
          << stamp.touched << ' ' << file.name << '\n';
  }
  for (const std::string& folder : old.folders) lines << "old-folder " << folder << '\n';
  return lines.str();
}

bool StagingJournal::read(std::string_view lines) {
  for (std::size_t end; (end = lines.find('\n')) != lines.npos; lines.remove_prefix(end + 1)) {
    std::istringstream line{std::string(lines.substr(0, end))};
    std::string kind, what;
    FileStamp stamp;
    line >> kind;
    if (kind == "made")
      line >> made.inode;
    else if (kind == "old")
      line >> old.inode, old.files.clear(), old.folders.clear();
    else if (kind == "old-file")
      line >> stamp.inode >> stamp.size >> stamp.changed >> stamp.touched;
    else if (kind != "file" && kind != "folder" && kind != "old-folder")
      return false;
    if (!line) return false;
    if (kind == "made" || kind == "old") continue;
    if (line.get() != ' ' || !std::getline(line, what) || !is_inside(what)) return false;
    if (kind == "file")
      made.files.push_back({what, std::nullopt});
    else if (kind == "folder")
      made.folders.push_back(what);
    else if (kind == "old-file")
      old.files.push_back({what, stamp});
    else
      old.folders.push_back(what);
  }
  return true;
}

/// What bears the name while it is made: the new folder, or after an exchange the old one.
int StagingJournal::remove_staged(const Folder& parent) const {
  const auto inode = parent.inode_of(name);
  if (!inode) return errno == ENOENT ? 0 : errno;
  if (*inode == 0) return 0;  // no folder, so none of ours
  if (*inode == made.inode) return remove_listed(parent, name, made);
  if (*inode == old.inode) return remove_listed(parent, name, old);
  return made.inode != 0 || remove_folder(parent, name)
             ? 0
             : errno;  // made and not yet noted, it is empty
}

int StagingJournal::remove_old(const Folder& parent, const std::string& place) const {
  const auto inode = parent.inode_of(old_name());
  if (!inode) return errno == ENOENT ? 0 : errno;
  if (*inode == 0 || *inode != old.inode) return 0;
  if (!parent.lacks(place)) return remove_listed(parent, old_name(), old);
  return move_to_new(parent, old_name(), place) ? 0 : errno;  // ended between two renames
}

int StagingJournal::remove(const Folder& parent, const std::string& place) const {
  const int old_fault = remove_old(parent, place), fault = remove_staged(parent);
  return old_fault != 0 ? old_fault : fault;
}

bool move_to_new(const Folder& parent, const std::string& from, const std::string& to) {
  const auto move = [&](unsigned how) {
    return uninterrupted([&] {
             return renameat2(parent.number(), from.c_str(), parent.number(), to.c_str(), how);
           }) == 0;
  };
  if (move(RENAME_NOREPLACE)) return true;
  if (errno != EINVAL && errno != ENOSYS && errno != ENOTSUP) return false;
  if (!parent.lacks(to)) return errno = EEXIST, false;
  return move(0);
}

}  // namespace plumb::io
