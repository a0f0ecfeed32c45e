#pragma once
/// The folder that a run leaves. It appears whole or not at all.

#include <filesystem>
#include <string>

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
  ~OutputFolder();  ///< removes what was half written
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Writes the documents and run.lock.yaml, then puts the folder into its place.
  void fill(const Plan& plan, const RunResult& result);

 private:
  std::filesystem::path folder_, partial_;
};

/// What run.lock.yaml holds: version, files, each step's version, the resolved pipeline. The same run gives the same text.
std::string lock_text(const Plan& plan, const std::vector<std::string>& files);

}  // namespace plumb
