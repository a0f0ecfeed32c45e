#pragma once
/// Where calls are made: `--isolate`, `--executor slurm` and what belongs to them.

#include <filesystem>
#include <memory>
#include <string>

#include "plumb/engine/run/executor.hpp"
#include "plumb/store/store.hpp"

namespace CLI {
class App;
}

namespace plumb::command {

struct ExecutorOptions {
  bool isolate = false;
  std::string executor = "local", time_limit, item_memory;
  std::filesystem::path profile;

  void add_to(CLI::App& command);
  bool needs_store() const { return isolate || executor == "slurm"; }
  /// None when calls are made in this process. `memory`: the run's bound [bytes], 0 for none.
  /// Throws Error, also for options that do not go together.
  std::unique_ptr<Executor> make(unsigned threads, std::uint64_t memory, bool verify_inputs,
                                 bool fresh, const Store* store) const;
};

}  // namespace plumb::command
