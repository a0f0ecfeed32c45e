#pragma once
/// A folder that is being made beside its place, and the marker that tells it from anything else.

#include <map>
#include <string>

#include "plumb/data/io/staging_journal.hpp"

namespace plumb::io {

/// Both lie in `parent`, `.PLACE.plumb-TOKEN` and `.PLACE.plumb-TOKEN.lock`, with a random token.
/// The marker holds the journal, and its maker holds a lock on it for as long as it lives, so that
/// no number of a process is ever compared. Not safe from several threads.
class Staging {
 public:
  /// Nothing is made yet.
  Staging(Folder& parent, std::string place) : parent_(parent), place_(std::move(place)) {}

  /// Makes marker and folder. This and the following: false, with errno.
  bool make();
  bool add_folder(const std::string& name);
  /// A new file to write to.
  Handle create(const std::string& name);
  /// The folders, to the disk.
  bool sync();
  /// Before that folder is replaced: what of it may be removed then.
  bool note_old(Listing old);

  /// 0 when all that was made or replaced and noted is gone, the marker too; else the errno of what
  /// was not possible.
  int remove();
  /// Takes the marker away alone, so that nothing removes the folder any more.
  bool forget();

  const StagingJournal& journal() const { return journal_; }
  const std::string& token() const { return token_; }

 private:
  bool draw_names();
  bool make_marker(const std::string& name);
  bool make_marker_by_name(const std::string& name);
  bool note(const std::string& lines);

  Folder& parent_;
  std::string place_, token_;
  StagingJournal journal_;
  Handle marker_;
  bool named_ = false;  ///< the marker can be seen
  Folder folder_;
  std::map<std::string, Folder> inner_;
};

/// Removes what a program that was killed left in `parent` of a folder `place`: what has a marker
/// of this user's that nobody holds, by its journal.
void remove_remains(const Folder& parent, const std::string& place);

/// Whether a file or folder bears the name of a marker or of a folder that is being made.
bool is_staging_name(const std::string& name);

}  // namespace plumb::io
