#include "plumb/engine/run/running_call.hpp"

#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {
namespace {

thread_local const RunningCall* innermost = nullptr;

}  // namespace

RunningCall::RunningCall(StepRun& run, std::size_t item)
    : run_(run), item_(item), outer_(innermost) {
  innermost = this;
}

RunningCall::~RunningCall() { innermost = outer_; }

std::string RunningCall::title() {
  if (innermost) return innermost->run_.title(innermost->item_);
  const std::string* path = Stopwatch::path();
  return path ? "step '" + *path + "'" : "";
}

}  // namespace plumb
