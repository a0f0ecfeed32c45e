#pragma once
/// Which call a thread makes, for whoever must name it without being told: when a step ends the
/// program.

#include <cstddef>
#include <string>

namespace plumb {

class StepRun;

/// Alive while a step has the word. They nest: frames are made inside the call that asks for them.
class RunningCall {
 public:
  RunningCall(StepRun& run, std::size_t item);
  ~RunningCall();
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;

  /// Of this thread, "step 'coarse.matches' (match.fpfh_mutual), edge 3-4"; at least the step where
  /// it works for a call of another thread; empty for none.
  static std::string title();

 private:
  StepRun& run_;
  std::size_t item_;
  const RunningCall* outer_;
};

}  // namespace plumb
