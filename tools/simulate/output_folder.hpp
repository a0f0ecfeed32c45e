#pragma once
/// A folder that appears whole or not at all.

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "plumb/data/io/staged_folder.hpp"

namespace plumb::simulate {

/// Written beside its place, then moved there. Destroyed before `finish`, it leaves nothing behind.
class OutputFolder {
 public:
  /// With the folders named in it. Throws Error where `place` exists and is neither empty nor an
  /// earlier simulation, unchanged, or cannot be made.
  explicit OutputFolder(const std::filesystem::path& place,
                        const std::vector<std::string>& folders = {});
  /// Writes a file; from any number of threads. Throws Error when the disk does not take it.
  void write(const std::string& name, const std::string& bytes);

  /// Writes scene.yaml, which also holds a hash of all that was written, and moves the folder to
  /// its place, in which an earlier simulation is replaced. Gives a sentence about what is not as
  /// it should be although the folder is in place; empty if all is well.
  std::string finish(const std::string& scene);

 private:
  std::mutex mutex_;
  std::map<std::string, Hash128> hashes_;
  io::StagedFolder staged_;
};

}  // namespace plumb::simulate
