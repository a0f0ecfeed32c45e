#pragma once
/// Worker processes on this machine.

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "plumb/engine/remote/worker/process.hpp"
#include "plumb/engine/remote/worker/task.hpp"

namespace plumb {

struct WorkerOptions {
  std::vector<std::string> command;  ///< that starts one: program and arguments
  unsigned workers = 1;
  std::optional<double> time_limit;  ///< of one call [s]
  int tries = 2;                     ///< of a call whose process was killed from outside
};

/// Starts workers as they are needed and keeps them until the end. A worker that crashes, hangs or
/// is killed costs its call and is replaced. Safe from several threads.
class WorkerPool {
 public:
  explicit WorkerPool(WorkerOptions options);
  ~WorkerPool();
  /// Makes all calls and tells of each; `done` is called from one thread at a time and may throw,
  /// which ends the task. `begins` is asked before each call, from any thread: when it says no, all
  /// calls that have not begun are left out. One task at a time: a second one waits until all
  /// calls of the first are done. Throws Error when no worker can be started.
  void make(const Task& task, const std::function<void(const Reply&)>& done,
            const std::function<bool(std::size_t item)>& begins);

 private:
  Reply ask(std::unique_ptr<WorkerProcess>& worker, std::uint64_t& has, const Task& task,
            const Call& call);
  WorkerOptions options_;
  std::mutex mutex_;  ///< held by the one task
  std::vector<std::unique_ptr<WorkerProcess>> workers_;
  std::vector<std::uint64_t> images_;  ///< by worker: number of the task whose image it has
  std::uint64_t task_ = 0;
};

}  // namespace plumb
