#pragma once
/// What a run gave, put into the order of its plan, whoever was first.

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/run/schedule.hpp"

namespace plumb {

class StepRun;

/// Safe from several threads, for one step one at a time.
class Gathered {
 public:
  explicit Gathered(const Plan& plan);
  /// The files and numbers of a step, in place of those of the pass before.
  void add(int step, StepRun& run);
  void add(const Turn& turn, LoopEnd loop);
  void add(const Turn& turn, Explained explained);
  /// All of it, with what was booked. Asked once, in the end.
  RunResult result(Bookkeeping& books);

 private:
  /// By step, in the order in which they would run one after the other.
  std::vector<StepTime> in_order(std::vector<StepTime> times) const;

  const Plan& plan_;
  std::vector<std::vector<std::shared_ptr<const Document>>> documents_;  ///< by step
  std::vector<std::vector<AnyValue>> numbers_;                           ///< by step
  std::mutex mutex_;                                                     ///< of the others
  std::map<Turn, LoopEnd> loops_;
  std::map<Turn, Explained> explained_;
};

}  // namespace plumb
