#pragma once
/// The folder that a run leaves. It appears whole or not at all.

#include <filesystem>
#include <string>

#include "plumb/data/io/staged_folder.hpp"
#include "plumb/engine/record/run_record.hpp"
#include "plumb/engine/run/runner.hpp"

namespace plumb {

/// Files are written beside the folder and moved into place at the end. An existing folder is
/// replaced only when everything in it is as an earlier run wrote it, by the sizes and hashes in
/// its run.lock.yaml; anything else is refused and not touched.
class OutputFolder {
 public:
  /// Makes sure, before anything runs, that the folder can be written. Throws Error with the reason
  /// and the cure.
  explicit OutputFolder(const std::filesystem::path& folder);

  /// Writes the documents and, with their names in `record`, run.lock.yaml; then puts the folder
  /// into its place. Throws Error: a name that is none or is given twice; a disk that is full;
  /// files of others that came into the folder meanwhile: then what was made stays beside it, and
  /// the sentence says where. Gives a sentence about what is not as it should be although the
  /// results are in place; empty if all is well.
  std::string fill(RunRecord record, const RunResult& result);

 private:
  io::StagedFolder staged_;
};

/// What is wrong with a name of a file in the output folder, as the end of a sentence; empty if
/// nothing is. Beside the rule for all names (plumb/data/file_name.hpp), the run's own record keeps
/// its name.
std::string fault_of_result_name(const std::string& name);

}  // namespace plumb
