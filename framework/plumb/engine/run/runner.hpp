#pragma once
/// Runs a checked pipeline.

#include <memory>
#include <string>
#include <vector>

#include "plumb/data/document.hpp"
#include "plumb/engine/cache/explain.hpp"
#include "plumb/engine/observe/bookkeeping.hpp"
#include "plumb/engine/run/executor.hpp"
#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/plugin/registry.hpp"
#include "plumb/store/store.hpp"

namespace plumb {

class SizeBound;

struct RunOptions {
  unsigned threads = 0;    ///< 0: as many as the machine has
  Store* store = nullptr;  ///< where results of earlier runs are found and those of this one kept
  bool fresh = false;      ///< nothing is taken from the store, but all is kept
  SizeBound* store_bound = nullptr;  ///< held after each step; in the end whoever has it sees to it
  /// Bound of resident memory [bytes], which needs a store and has steps run one after the other;
  /// 0: none.
  std::size_t memory = 0;
  /// Makes the calls; one that makes them in other processes needs a store. None: a LocalExecutor.
  Executor* executor = nullptr;
};

/// How a repeat ended.
struct LoopEnd {
  std::string path;
  int passes = 0;
  std::string why;
};

/// A file that a step made.
struct MadeDocument {
  std::string path;  ///< of the step
  std::shared_ptr<const Document> document;
};

/// A value with numbers that a step on whole collections gave.
struct MadeNumbers {
  std::string path;
  AnyValue value;
};

struct RunResult {
  std::vector<MadeDocument> documents;
  std::vector<MadeNumbers> numbers;  ///< every such value; of a repeat its last pass
  std::vector<LoopEnd> loops;        ///< in the plan's order
  std::vector<std::string> warnings;
  std::vector<StepCount> counts;
  std::vector<StepTime> times;       ///< by step, in the plan's order
  std::vector<Explained> explained;  ///< with a store: each step in each pass, in the plan's order
  double seconds = 0;                ///< wall clock
  std::size_t peak_bytes = 0;  ///< of resident memory without mapped files, of all its processes
};

/// Runs all steps. Throws Error that names step and item; nothing is written to disk here.
RunResult run_plan(const Plan& plan, const Registry& registry, const RunOptions& options,
                   Observer& observer);

}  // namespace plumb
