#pragma once
/// The folder that a run leaves. It appears whole or not at all.

#include <filesystem>
#include <string>

#include "plumb/data/io/staged_folder.hpp"
#include "plumb/engine/runner.hpp"

namespace plumb {

/// Name of the file that tells a folder of ours from any other; it lists the files that belong to the run.
inline constexpr const char* lock_name = "run.lock.yaml";

/// Files are written beside the folder and renamed into place at the end. An existing folder is replaced only when everything in it was
/// written by an earlier run; anything else is refused and not touched.
class OutputFolder {
 public:
  /// Makes sure, before anything runs, that the folder can be written. Throws Error with the reason and the cure.
  explicit OutputFolder(const std::filesystem::path& folder);

  /// Writes the documents and run.lock.yaml, then puts the folder into its place. Throws Error: a name that is none or is given twice; a disk that is full;
  /// files of others that came into the folder meanwhile: then what was made stays beside it, and the sentence says where.
  void fill(const Plan& plan, const RunResult& result);

 private:
  io::StagedFolder staged_;
};

/// What is wrong with a name of a file in the output folder, as the end of a sentence; empty if nothing is.
std::string fault_of_file_name(const std::string& name);

/// What run.lock.yaml holds: version, files, each step's version, the resolved pipeline. The same run gives the same text.
std::string lock_text(const Plan& plan, const std::vector<std::string>& files);

}  // namespace plumb
