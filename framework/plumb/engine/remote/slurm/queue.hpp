#pragma once
/// Slurm as its command line has it: sinfo, sbatch, squeue, scancel. Nothing else of Plumb knows
/// it.

#include <string>
#include <vector>

namespace plumb {

/// What a command said and how it ended.
struct CommandSaid {
  int code = -1;  ///< 127: there is no such program
  std::string out, err;
};
CommandSaid run_command(const std::vector<std::string>& words);

/// One array of chunks to be run.
struct Submission {
  std::string name, partition, time, log;  ///< empty: the site's own
  std::uint64_t memory = 0;                ///< of a chunk [bytes]; 0: the site's own
  unsigned cpus = 1;                       ///< of a chunk
  std::size_t chunks = 1;
  std::vector<std::string> command;  ///< gets the chunk's number as its last word
};

enum class JobState {
  active,   ///< some chunk waits or runs
  over,     ///< none does, or nobody knows the job any more
  unknown,  ///< the controller does not answer
};

class SlurmQueue {
 public:
  /// Throws Error: Slurm is not installed here, its controller does not answer, or it has no such
  /// partition.
  void require(const std::string& partition) const;
  /// Throws Error: Slurm is not installed here, or takes no job (in its own words).
  std::string submit(const Submission& submission);
  JobState state(const std::string& job);
  void cancel(const std::string& job);
};

}  // namespace plumb
