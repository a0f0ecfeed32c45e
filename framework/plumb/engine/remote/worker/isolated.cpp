#include "plumb/engine/remote/worker/isolated.hpp"

#include "plumb/engine/remote/worker/image.hpp"

namespace plumb {

Prepared prepared(StepRun& run, const std::vector<std::size_t>& calls, unsigned threads) {
  Prepared result;
  result.task.image = to_bytes(image_of(run, result.runs));
  result.task.threads = run.itemwise() ? 1 : threads;
  for (const std::size_t k : calls)
    result.task.calls.push_back(
        {k, run.itemwise() ? run.item_keys()[k] : run.whole_key(), run.title(k)});
  return result;
}

void book_passed(const Reply& reply, const std::vector<StepRun*>& runs) {
  for (const PassedCounts& passed : reply.passed)
    if (passed.run < runs.size()) runs[passed.run]->book_passed(passed);
}

void make_by(WorkerPool& pool, StepRun& run, const Task& task, const std::vector<StepRun*>& runs,
             const std::function<void(const Reply&)>& taken) {
  pool.make(
      task,
      [&](const Reply& reply) {
        book_passed(reply, runs);
        run.take(reply);
        taken(reply);
      },
      [&](std::size_t) { return !run.stopped(); });
}

void IsolatedExecutor::make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) {
  const Prepared work = prepared(run, calls, threads_);
  make_by(pool_, run, work.task, work.runs,
          [&](const Reply& reply) { done(reply.item, reply.fault); });
}

}  // namespace plumb
