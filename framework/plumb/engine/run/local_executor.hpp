#pragma once
/// `--executor local`: calls are made in this process, on the threads of the run.

#include "plumb/engine/run/admission.hpp"
#include "plumb/engine/run/executor.hpp"

namespace plumb {

/// Results stay where they are made: nothing is encoded or copied.
class LocalExecutor final : public Executor {
 public:
  /// `memory` [bytes] that calls on items may need together; 0: no bound.
  explicit LocalExecutor(std::size_t memory) : admission_(memory) {}
  void make(StepRun& run, const std::vector<std::size_t>& calls, const Done& done) override;
  bool elsewhere() const override { return false; }

 private:
  Admission admission_;
};

}  // namespace plumb
