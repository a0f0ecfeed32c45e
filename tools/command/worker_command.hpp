#pragma once
/// The command line that starts a worker of this very program.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumb::command {

struct WorkerCommand {
  std::filesystem::path store;
  std::uint64_t memory = 0;  ///< what it may allocate [bytes]; 0: no bound
  bool contents = false;     ///< input files count by their content
  bool trusted = false;      ///< the store may be anyone's
};

/// Program and arguments; the run's plugin folders go along.
std::vector<std::string> words_of(const WorkerCommand& worker);

}  // namespace plumb::command
