/// The seam to the thread pool in a build for ThreadSanitizer, which sees nothing of what oneTBB's
/// library does and takes its hand-overs for races: the same functions with threads of the standard
/// library, begun and joined by each loop.
#include <algorithm>
#include <atomic>
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

}  // namespace

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
