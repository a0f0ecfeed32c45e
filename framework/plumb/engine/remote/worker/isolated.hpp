#pragma once
/// `--executor process`: all calls are made by worker processes on this machine.

#include "plumb/engine/remote/worker/pool.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {

/// A run's calls as a task, and the runs that the image's entries stand for.
struct Prepared {
  Task task;
  std::vector<StepRun*> runs;
};
/// `threads`: that one call may use; calls on items get one each.
Prepared prepared(StepRun& run, const std::vector<std::size_t>& calls, unsigned threads);

/// Books what steps counted whose values passed through a call, each value once.
void book_passed(const Reply& reply, const std::vector<StepRun*>& runs);

/// Has `pool` make the calls of `task`, which are calls of `run`, and tells of each that `run` has
/// taken; `runs` are those of the task's image.
void make_by(WorkerPool& pool, StepRun& run, const Task& task, const std::vector<StepRun*>& runs,
             const std::function<void(const Reply&)>& taken);

/// Its pool takes one step's calls at a time; meanwhile this process may do its own part of others.
class IsolatedExecutor final : public Executor {
 public:
  explicit IsolatedExecutor(WorkerOptions options)
      : threads_(options.workers), pool_(std::move(options)) {}
  void make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) override;
  bool elsewhere() const override { return true; }

 private:
  unsigned threads_;
  WorkerPool pool_;
};

}  // namespace plumb
