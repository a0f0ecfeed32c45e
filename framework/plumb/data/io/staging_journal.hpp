#pragma once
/// What belongs to a folder that is being made, so that this is removed after a failure or a kill,
/// and nothing else.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/data/io/folder.hpp"

namespace plumb::io {

struct ListedFile {
  std::string name;  ///< in the folder; may lie in one of its folders ("frames/000000.pcd")
  std::optional<FileStamp> stamp;  ///< none: whichever regular file bears the name
};

/// All that a program knows to have made in a folder.
struct Listing {
  std::uint64_t inode = 0;  ///< the folder's; 0: there is none yet
  std::vector<ListedFile> files;
  std::vector<std::string> folders;  ///< outer ones first
};

/// Whether all that is listed is there, unchanged, and nothing else.
bool is_as_listed(const Folder& folder, const Listing& listing);

/// Of one folder that is being made in a parent. Each entry has a line of text.
struct StagingJournal {
  std::string name;  ///< of the folder while it is made
  Listing made;      ///< in it
  Listing old;  ///< in the folder that it replaces, which then bears its name, or old_name() where
                ///< two cannot be exchanged

  std::string old_name() const { return name + ".old"; }
  static std::string line_of(const char* kind, const std::string& what) {
    return std::string(kind) + " " + what + "\n";
  }
  std::string lines_of_old() const;
  /// Takes the lines of a marker; a last one that a kill cut is left out. False: some other line is
  /// none of a journal.
  bool read(std::string_view lines);

  /// Puts back a replaced folder if `place` is missing, removes what is listed, and then the
  /// folders. 0, or the errno of the first thing that was not possible; ENOTEMPTY when something
  /// else is in a folder: that stays.
  int remove(const Folder& parent, const std::string& place) const;

 private:
  int remove_staged(const Folder& parent) const;
  int remove_old(const Folder& parent, const std::string& place) const;
};

/// rename() that replaces nothing.
bool move_to_new(const Folder& parent, const std::string& from, const std::string& to);

}  // namespace plumb::io
