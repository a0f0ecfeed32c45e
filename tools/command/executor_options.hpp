#pragma once
/// Where calls are made: `--executor` and what belongs to it.

#include <filesystem>
#include <memory>
#include <string>

#include "plumb/engine/run/executor.hpp"
#include "plumb/store/store.hpp"

namespace plumb::command {

class Command;  // command_line.hpp

struct ExecutorOptions {
  bool isolate = false;  ///< by the former name of --executor process
  std::string executor, time_limit, item_memory;
  std::filesystem::path profile;

  void add_to(Command& command);
  /// Throws UsageError for options that do not go together, and for values that are none.
  /// `memory`: the run's bound [bytes], 0 for none.
  void require_one_meaning(unsigned threads, std::uint64_t memory) const;
  /// "local", "process" or "slurm".
  std::string where() const { return isolate ? "process" : executor.empty() ? "local" : executor; }
  bool needs_store() const { return where() != "local"; }
  /// None when calls are made in this process. Throws Error, for the profile too.
  std::unique_ptr<Executor> make(unsigned threads, std::uint64_t memory, bool verify_inputs,
                                 bool fresh, const Store* store) const;

 private:
  double seconds_of_call() const;
  /// [byte]
  std::uint64_t memory_of_worker(unsigned workers, std::uint64_t memory) const;
};

}  // namespace plumb::command
