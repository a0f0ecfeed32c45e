#pragma once
/// Files that a run writes beside its results: --log, --events, --trace.

#include <filesystem>
#include <string>
#include <vector>

namespace plumb::command {

struct SideFile {
  std::string option;          ///< "--log"
  std::filesystem::path file;  ///< empty: not asked for
  std::string what;            ///< "log"
  std::string mark;            ///< how the first line of each such file begins
};

/// Makes sure that none lies in the folder for the results, which holds what the run made and
/// nothing else, or is another of them. Throws Error.
void require_elsewhere(const std::vector<SideFile>& files, const std::filesystem::path& output);

/// Makes sure that neither the store (empty: there is none) nor the folder for the results lies in
/// the other. Throws Error.
void require_apart(const std::filesystem::path& store, const std::filesystem::path& output);

/// Empties the file; an earlier one of the same kind is replaced, pipes and devices are left as
/// they are. Throws Error: something else is there; it cannot be written.
void begin(const SideFile& file);

}  // namespace plumb::command
