#pragma once
/// The one seam to the thread pool: everything parallel in Plumb goes through here.

#include <cstddef>
#include <functional>

namespace plumb {

/// Calls body(k) for k = 0 .. n-1 on the pool and waits. Calls may nest. When bodies throw, the
/// exception of the smallest k that was seen is rethrown after all others have ended, and bodies
/// that have not begun are left out. A thread that waits here begins nothing but these bodies.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body);

/// Calls `task` n times on the pool, and as many times more as each call returns, and waits for
/// all. A call begins as soon as a thread is free, this one or another; as long as none is due,
/// this one helps with whatever loops the calls have begun. Not from within a loop or a task; a
/// task throws nothing.
void run_tasks(std::size_t n, const std::function<std::size_t()>& task);

/// Runs `body` with at most `threads` threads (0: as many as the machine has).
void with_threads(unsigned threads, const std::function<void()>& body);

/// Threads that the pool may use here.
unsigned thread_count();

}  // namespace plumb
