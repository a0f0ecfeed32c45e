#pragma once
/// Files that a run writes beside its results: --log, --events, --trace.

#include <filesystem>
#include <string>
#include <vector>

#include "store_option.hpp"

namespace plumb::command {

struct SideFile {
  std::string option;          ///< "--log"
  std::filesystem::path file;  ///< empty: not asked for
  std::string what;            ///< "log"
  std::string mark;            ///< how the first line of each such file begins
};

/// Makes sure that none lies in the folder for the results, which holds what the run made and
/// nothing else, or is another of them. Throws Error, which names -o when that is a place for no
/// results anyhow.
void require_elsewhere(const std::vector<SideFile>& files, const std::filesystem::path& output);

/// Makes sure that neither the cache nor the folder for the results lies in the other. Throws
/// Error, which names the one that is to be changed: what no option says is where it always is, and
/// what holds other things is wrong by itself.
void require_apart(const StoreOption& store, const std::filesystem::path& output);

/// Empties the file; an earlier one of the same kind is replaced, pipes and devices are left as
/// they are. Throws Error: something else is there; it cannot be written.
void begin(const SideFile& file);

}  // namespace plumb::command
