#pragma once
/// A folder that appears whole or not at all.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/data/io/staged_folder.hpp"

namespace plumb::simulate {

/// Written beside its place, then renamed. Destroyed before `finish`, it leaves nothing behind.
class OutputFolder {
 public:
  /// With the folders named in it. Throws Error where `place` exists and is neither empty nor an
  /// earlier simulation, or cannot be made.
  explicit OutputFolder(const std::filesystem::path& place,
                        const std::vector<std::string>& folders = {});
  /// Writes a file; from any number of threads. Throws Error when the disk does not take it.
  void write(const std::filesystem::path& relative, const std::string& bytes) const;

  /// Moves the folder to its place, in which an earlier simulation is replaced.
  void finish() { staged_.finish(); }

 private:
  io::StagedFolder staged_;
};

}  // namespace plumb::simulate
