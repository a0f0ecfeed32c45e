/// plumb worker: makes calls for a run in another process, at the other end of a socket or as a
/// chunk of a Slurm job.

#include <fcntl.h>

#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/io/file_identity.hpp"
#include "plumb/engine/remote/slurm/chunk.hpp"
#include "plumb/engine/remote/worker/service.hpp"
#include "usage.hpp"
#include "worker_command.hpp"

namespace plumb::command {
namespace {

struct Options {
  WorkerCommand worker;
  std::filesystem::path task;
  std::size_t chunk_size = 1, chunk = 0;
  unsigned cpus = 1;
  double time_limit = 0;
};

/// Whether a driver is at the other end of a socket; a chunk has none.
bool is_connected(const Options& options) {
  return options.task.empty() && fcntl(WorkerProcess::channel, F_GETFD) >= 0;
}

void run(Options& options) {
  if (options.task.empty() && !is_connected(options))
    throw UsageError(
        "worker: is started by 'plumb run --executor process' and by Slurm jobs of 'plumb run "
        "--executor slurm', not by hand");
  Store store(options.worker.store, StoreRole::worker,
              options.worker.trusted ? Whose::anyones : Whose::own);
  if (!options.task.empty()) {
    WorkerOptions workers;
    workers.command = words_of(options.worker);
    workers.workers = options.cpus;
    if (options.time_limit > 0) workers.time_limit = options.time_limit;
    make_chunk(options.task, options.chunk, options.chunk_size, store, std::move(workers));
    return;
  }
  if (options.worker.contents) io::identify_files_by(io::FileIdentity::content);
  serve_calls(WorkerProcess::channel, installed_steps(), store, options.worker.memory);
}

void run_or_refuse(Options& options) {
  try {
    run(options);
  } catch (const Error& e) {
    if (!is_connected(options)) throw;
    refuse_calls(WorkerProcess::channel, e.what());
  }
}

}  // namespace

void add_worker(Command& program) {
  Command command = program.add_subcommand(
      "worker", "Makes calls for a run: started by run --executor process and by Slurm jobs");
  auto options = std::make_shared<Options>();
  command.add_option("--cache-dir", options->worker.store, "Folder of the run's results")
      .required();
  command.add_flag("--trust-cache", options->worker.trusted, "The cache may be anyone's");
  command.add_option("--memory", options->worker.memory,
                     "What the process may allocate [bytes]; 0 for no bound");
  command.add_flag("--contents", options->worker.contents, "Input files count by their content");
  command.add_option("--task", options->task, "The calls of a Slurm job");
  command.add_option("--chunk-size", options->chunk_size, "Calls of a chunk").positive();
  command.add_option("--cpus", options->cpus, "Calls at a time").range(1, 1024);
  command.add_option("--time-limit", options->time_limit, "Of one call [s]; 0 for none");
  command.add_option("--chunk", options->chunk, "Which chunk, from 0");
  command.footer(
      "Example: none; it is not meant to be started by hand. `plumb run --help` has "
      "--executor.");
  command.callback([options] { run_or_refuse(*options); });
}

}  // namespace plumb::command
