#include "plumb/engine/run/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <atomic>
#include <exception>
#include <mutex>

namespace plumb {

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body) {
  if (n == 0) return;
  if (n == 1) return body(0);
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr failure;
  std::size_t failed_at = 0;
  // Isolated: a thread that waits here takes no task from outside, which might need the item that
  // this one is making.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t k = range.begin(); k != range.end(); ++k) {
            if (failed.load(std::memory_order_relaxed)) return;
            try {
              body(k);
            } catch (...) {
              const std::lock_guard lock(mutex);
              if (!failure || k < failed_at) {
                failure = std::current_exception();
                failed_at = k;
              }
              failed = true;
            }
          }
        },
        tbb::simple_partitioner());
  });
  if (failure) std::rethrow_exception(failure);
}

void run_tasks(std::size_t n, const std::function<std::size_t()>& task) {
  tbb::task_group group;
  // One is for this thread, which goes on with one of those that it makes due. No isolation: who
  // waits here makes nothing that others could need.
  const std::function<void(std::size_t)> work = [&](std::size_t due) {
    while (due > 0) {
      for (; due > 1; --due) group.run([&work] { work(1); });
      due = task();
    }
  };
  work(n);
  group.wait();
}

void with_threads(unsigned threads, const std::function<void()>& body) {
  if (threads == 0) threads = static_cast<unsigned>(tbb::this_task_arena::max_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute(body);
}

unsigned thread_count() { return static_cast<unsigned>(tbb::this_task_arena::max_concurrency()); }

}  // namespace plumb
