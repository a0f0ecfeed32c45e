#pragma once
/// `--executor slurm`: calls on items as chunked arrays of a Slurm cluster whose machines share the
/// store's folder. What counts is what lies in the store, not what Slurm says.

#include "plumb/engine/remote/slurm/job_folder.hpp"
#include "plumb/engine/remote/slurm/profile.hpp"
#include "plumb/engine/remote/slurm/queue.hpp"
#include "plumb/engine/remote/worker/isolated.hpp"

namespace plumb {

struct SlurmOptions {
  ExecutorProfile profile;
  std::filesystem::path store;             ///< folder that all machines see
  bool fresh = false;                      ///< results of earlier runs are removed and made again
  std::vector<std::string> chunk_command;  ///< program and arguments of a worker for chunks;
                                           ///< --task, --chunk-size and --chunk are added
};

/// Steps on whole collections, and steps with little to do, are made by workers on this machine,
/// one step at a time. Jobs of several steps may run at the same time. Safe to kill: a later run of
/// the same pipeline finds the job of a step that still runs and waits for it.
class SlurmExecutor final : public Executor {
 public:
  /// Throws Error when Slurm does not answer or has no such partition.
  SlurmExecutor(SlurmOptions options, WorkerOptions here);
  void make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) override;
  bool elsewhere() const override { return true; }

 private:
  bool worth_submitting(const Reply& first, std::size_t more) const;
  void submit_and_wait(StepRun& run, Prepared work, const Done& done);
  SlurmOptions options_;
  unsigned threads_;
  WorkerPool pool_;
  SlurmQueue queue_;
};

}  // namespace plumb
