#include "executor_options.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "command_line.hpp"
#include "plumb/data/amount.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/remote/slurm/slurm_executor.hpp"
#include "usage.hpp"
#include "worker_command.hpp"

namespace plumb::command {
namespace {

/// Less does not hold the program itself.
constexpr std::uint64_t least_of_worker = std::uint64_t{64} << 20;

std::uint64_t memory_of_machine() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

unsigned workers_of(unsigned threads) {
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

std::string too_little(std::uint64_t bytes, const std::string& given) {
  return given + ": leaves a worker " + text_of_bytes(bytes) +
         ", which is too little to run in; give 64MiB or more for each";
}

}  // namespace

void ExecutorOptions::add_to(Command& command) {
  command
      .add_option("--executor", executor,
                  "Where calls are made: local, in this process; process, in worker processes, so "
                  "that a module that crashes or hangs costs its item; slurm, on the cluster whose "
                  "machines share the cache")
      .one_of({"local", "process", "slurm"})
      .default_str("local");
  command.add_flag("--isolate", isolate, "Former name of --executor process").group("");
  command.add_option("--executor-profile", profile,
                     "Partition, time, memory, chunk and so on of the cluster's jobs (YAML)");
  command.add_option("--time-limit", time_limit,
                     "Of one call in a worker, such as 90s or 10min; without it 1h");
  command.add_option(
      "--item-memory", item_memory,
      "What a worker may allocate, such as 4GiB; without it --memory, or the machine's");
}

void ExecutorOptions::require_one_meaning(unsigned threads, std::uint64_t memory) const {
  if (isolate && !executor.empty() && executor != "process")
    throw UsageError("--isolate: is the former name of --executor process, and --executor " +
                     executor + " is given too; leave one of them out");
  if (where() != "slurm" && !profile.empty())
    throw UsageError("--executor-profile " + profile.string() +
                     ": is for --executor slurm, which is not given");
  if (needs_store()) {
    seconds_of_call();
    memory_of_worker(workers_of(threads), memory);
    return;
  }
  for (const auto& [option, value] :
       {std::pair("--item-memory ", item_memory), std::pair("--time-limit ", time_limit)})
    if (!value.empty())
      throw UsageError(option + value + ": is for workers; give --executor process or slurm too");
}

double ExecutorOptions::seconds_of_call() const {
  const auto limit =
      usage([&] { return age_of_text("--time-limit", time_limit.empty() ? "1h" : time_limit); });
  const double seconds = std::chrono::duration<double>(limit).count();
  if (seconds <= 0 || seconds > 1e8)
    throw UsageError("--time-limit " + time_limit +
                     ": give a time above zero and below three years, as in 10min");
  return seconds;
}

std::uint64_t ExecutorOptions::memory_of_worker(unsigned workers, std::uint64_t memory) const {
  const bool given = !item_memory.empty();
  const std::uint64_t bytes =
      given        ? usage([&] { return bytes_of_text("--item-memory", item_memory); })
      : memory > 0 ? memory / workers
                   : memory_of_machine();
  if (bytes < least_of_worker)
    throw UsageError(too_little(bytes, given ? "--item-memory " + item_memory
                                             : "--memory for " + counted(workers, "workers")));
  return bytes;
}

std::unique_ptr<Executor> ExecutorOptions::make(unsigned threads, std::uint64_t memory,
                                                bool verify_inputs, bool fresh,
                                                const Store* store) const {
  if (!needs_store()) return nullptr;
  WorkerCommand worker;
  worker.store = store->folder();
  worker.trusted = store->whose() == Whose::anyones;
  worker.contents = verify_inputs;
  WorkerOptions workers;
  workers.workers = workers_of(threads);
  worker.memory = memory_of_worker(workers.workers, memory);
  workers.command = words_of(worker);
  workers.time_limit = seconds_of_call();
  if (where() != "slurm") return std::make_unique<IsolatedExecutor>(std::move(workers));
  SlurmOptions options;
  if (!profile.empty()) options.profile = read_profile(profile);
  options.store = store->folder();
  options.fresh = fresh;
  if (item_memory.empty() && options.profile.memory > 0)
    worker.memory = options.profile.memory / options.profile.cpus;
  if (worker.memory < least_of_worker)
    throw Error(too_little(worker.memory, "memory of a chunk in " + profile.string()));
  options.chunk_command = words_of(worker);
  options.chunk_command.insert(options.chunk_command.end(),
                               {"--cpus", std::to_string(options.profile.cpus), "--time-limit",
                                std::to_string(*workers.time_limit)});
  return std::make_unique<SlurmExecutor>(std::move(options), std::move(workers));
}

}  // namespace plumb::command
