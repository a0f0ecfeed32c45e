#pragma once
/// How a site's Slurm wants its jobs: an executor profile in YAML, which is no part of a pipeline.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/plugin/description.hpp"

namespace plumb {

struct ExecutorProfile {
  std::string partition;     ///< empty: the site's default
  std::string time;          ///< as sbatch takes it: "30", "1:00:00"; empty: the partition's
  std::uint64_t memory = 0;  ///< of a chunk [bytes]; 0: the partition's
  unsigned cpus = 1;         ///< of a chunk: so many workers make its calls at a time
  std::size_t chunk = 50;    ///< calls of an array element
  double submit_above = 10;  ///< work of a step that is expected to take less than this [s] is made
                             ///< by workers on the driver's own machine
  unsigned tries = 2;        ///< of a call whose process does not survive it
  double poll = 2;           ///< longest time between two looks at the queue [s]
};

/// The keys that a profile may have, for checks and help.
const std::vector<ParameterDescription>& profile_keys();

/// Reads a profile. Throws PipelineError with file:line:column of every mistake.
ExecutorProfile read_profile(const std::filesystem::path& file);

}  // namespace plumb
