#include "plumb/engine/run/local_executor.hpp"

#include <mutex>

#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {

void LocalExecutor::make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) {
  const bool bounded = admission_.bounded() && run.itemwise();
  std::mutex mutex;
  parallel_for(calls.size(), [&](std::size_t c) {
    if (run.stopped()) return;
    const std::size_t call = calls[c];
    std::string fault;
    try {
      const Admission::Ticket ticket(admission_, bounded ? run.expected_bytes(call) : 0);
      run.make_here(call);
    } catch (const NestedError& e) {
      fault = e.what();
    }
    const std::lock_guard lock(mutex);
    done(call, fault);
  });
}

}  // namespace plumb
