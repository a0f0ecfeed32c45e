#pragma once
/// A folder of results that appears whole or not at all.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "plumb/data/error.hpp"
#include "plumb/data/io/staging.hpp"

namespace plumb::io {

/// The disk does not take what was made: no wrong input, but a failure at the end of work.
class WriteError : public Error {
 public:
  using Error::Error;
};

/// Files are written to a folder beside the place (Staging), which finish() exchanges for what is
/// there, by one rename where the system has it; files and folders are on the disk before. Without
/// finish() the destructor removes them, and so does remove_all_staging() when the program is
/// interrupted. What a program that was killed left beside the same place is removed by the next
/// one, and what it had moved away to make room is moved back.
///
/// Never is anything removed that was not made by a StagedFolder: not beside the place, and not in
/// it. A place that is a link means the folder that it leads to.
class StagedFolder {
 public:
  /// Looks at a folder that stands at the place, which has the path `shown`, and lists all that is
  /// in it, with stamps of the files. Throws Error when it holds something that was not made by a
  /// program like this one, or is no longer as it was made.
  using Proof = std::function<Listing(const Folder& folder, const std::filesystem::path& shown)>;

  /// `cure` ends sentences: "give another folder with -o". Throws Error: the place is empty, a
  /// file, a link to nothing, or cannot be written; what `proof` throws.
  StagedFolder(const std::filesystem::path& place, std::string cure, Proof proof);
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  ~StagedFolder();

  const std::filesystem::path& place() const { return place_; }
  /// Throws WriteError, like write().
  void add_folder(const std::string& name);
  /// Writes a new file; from any number of threads. `give` hands its bytes on. Throws WriteError:
  /// the disk does not take it.
  void write(const std::string& name, const std::function<void(const Take& take)>& give);
  /// Throws what `proof` does for what came into the folder meanwhile.
  void look_again();
  /// Replaces the place by what is staged. Throws WriteError: that cannot be done; what `proof`
  /// throws: what is there changed. Then all is as before. Gives a sentence about what is not as it
  /// should be although the new folder is in place; empty if all is well.
  std::string finish();
  /// Keeps what is staged beside the place, for good, and says where.
  std::filesystem::path keep();

 private:
  friend void remove_all_staging();
  std::string sentence(const std::string& what, int why) const;
  [[noreturn]] void refuse(const std::string& what, int why) const;  ///< throws Error
  [[noreturn]] void fail(const std::string& what, int why) const;    ///< throws WriteError
  void make_parents();
  std::optional<Listing> look() const;
  bool is_unchanged() const;
  bool swap();
  std::string settle();
  std::filesystem::path kept_name(const std::string& of);

  std::filesystem::path place_;
  std::string cure_, name_;  ///< the place's last part
  Proof proof_;
  Folder parent_;
  std::optional<Staging> staging_;
  std::optional<Listing> old_;  ///< at the place
};

/// Removes what all StagedFolders of this process have staged; a finish() that has begun ends
/// first, and none begins any more: the process must end. From any thread.
void remove_all_staging();

}  // namespace plumb::io
