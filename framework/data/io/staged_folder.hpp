#pragma once
/// A folder of results that appears whole or not at all.

#include <filesystem>
#include <string>

namespace plumb::io {

/// Files are written to `staging()`, a folder beside the place, and moved to the place by finish(). Without finish() the
/// destructor removes them, and so does remove_all_staging() when the program is interrupted. What a program that was killed left beside the same place is removed by
/// the next one on the same machine, and what it had moved away to make room is moved back. A place that is a link means the folder that it leads to.
class StagedFolder {
 public:
  /// `cure` ends sentences: "give another folder with -o". Throws Error: the place is empty, a file, a link to nothing, or cannot be written.
  StagedFolder(const std::filesystem::path& place, std::string cure);
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  ~StagedFolder();

  const std::filesystem::path& place() const { return place_; }
  const std::filesystem::path& staging() const { return staging_; }
  /// Replaces the place by what is staged. Throws Error: that cannot be done; then all is as before.
  void finish();
  /// Keeps what is staged beside the place, for good, and says where.
  std::filesystem::path keep();

 private:
  std::filesystem::path place_, staging_;
  std::string cure_;
};

/// Removes what all StagedFolders of this process have staged; a finish() that has begun ends first, and none begins any more: the process must end.
/// From any thread.
void remove_all_staging();

}  // namespace plumb::io
