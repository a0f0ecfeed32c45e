/// The seam to the thread pool in a build for ThreadSanitizer, which sees nothing of what oneTBB's
/// library does and takes its hand-overs for races: the same functions with threads of the standard
/// library, begun and joined by each loop or set of tasks.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "plumb/engine/run/parallel.hpp"

namespace plumb {
namespace {

unsigned of_machine() { return std::max(1u, std::thread::hardware_concurrency()); }

std::atomic<unsigned> most{of_machine()};  ///< threads that may run, with the one that began
std::atomic<unsigned> helpers{0};          ///< that run

/// Whether one more thread may begin.
bool take_helper() {
  unsigned running = helpers.load();
  while (running + 1 < most.load())
    if (helpers.compare_exchange_weak(running, running + 1)) return true;
  return false;
}

/// What the threads of one loop share.
class Loop {
 public:
  Loop(std::size_t n, const std::function<void(std::size_t)>& body) : n_(n), body_(body) {}

  void work() {
    for (std::size_t k = next_++; k < n_ && !failed_; k = next_++) {
      try {
        body_(k);
      } catch (...) {
        fail(k);
      }
    }
  }
  void rethrow() {
    if (failure_) std::rethrow_exception(std::move(failure_));
  }

 private:
  void fail(std::size_t k) {
    const std::lock_guard lock(mutex_);
    if (!failure_ || k < failed_at_) {
      failure_ = std::current_exception();
      failed_at_ = k;
    }
    failed_ = true;
  }
  const std::size_t n_;
  const std::function<void(std::size_t)>& body_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::size_t failed_at_ = 0;
};

/// What the threads of a set of tasks share. A helper is begun for each task that is due beyond the
/// one that its own thread takes, as far as threads are left, and ends when none is due.
class Tasks {
 public:
  Tasks(std::size_t n, const std::function<std::size_t()>& task) : task_(task), due_(n) {}

  void run() {
    work(false);
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work(bool helps) {
    std::unique_lock lock(mutex_);
    while (due_ > 0 || (running_ > 0 && !helps)) {
      if (due_ == 0) {
        changed_.wait(lock);
        continue;
      }
      --due_, ++running_;
      for (std::size_t k = 0; k < due_ && take_helper(); ++k)
        threads_.emplace_back([this] { work(true); });
      lock.unlock();
      const std::size_t more = task_();
      lock.lock();
      --running_, due_ += more;
      changed_.notify_all();
    }
    if (helps) --helpers;
  }
  const std::function<std::size_t()>& task_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t due_, running_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace

void run_tasks(std::size_t n, const std::function<std::size_t()>& task) { Tasks(n, task).run(); }

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body) {
  Loop loop(n, body);
  std::vector<std::thread> threads;
  while (threads.size() + 1 < n && take_helper())
    threads.emplace_back([&loop] {
      loop.work();
      --helpers;
    });
  loop.work();
  for (std::thread& thread : threads) thread.join();
  loop.rethrow();
}

void with_threads(unsigned threads, const std::function<void()>& body) {
  struct Restored {
    unsigned before;
    ~Restored() { most = before; }
  } const restored{most.exchange(threads == 0 ? of_machine() : threads)};
  body();
}

unsigned thread_count() { return most; }

}  // namespace plumb
