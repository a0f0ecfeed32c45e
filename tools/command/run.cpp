/// plumb run: checks, runs, reports.

#include <algorithm>
#include <iostream>
#include <memory>

#include "console.hpp"
#include "interrupt.hpp"
#include "pipeline_options.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/output_folder.hpp"
#include "plumb/engine/preflight.hpp"
#include "plumb/engine/runner.hpp"
#include "summary.hpp"

namespace plumb::command {
namespace {

struct Options {
  PipelineOptions pipeline;
  std::filesystem::path output;
  unsigned threads = 0;
  bool quiet = false, times = false, fresh = false;
  std::string log;
  std::filesystem::path store;
};

/// The output folder holds what the run made and nothing else.
void require_log_elsewhere(const Options& options) {
  if (options.log.empty()) return;
  const auto log = std::filesystem::weakly_canonical(options.log), folder = std::filesystem::weakly_canonical(options.output);
  const auto [end, _] = std::mismatch(folder.begin(), folder.end(), log.begin(), log.end());
  if (end == folder.end())
    throw Error("--log " + options.log + ": lies in the folder for the results, which holds what steps wrote alone; name a file beside it");
}

void say_of_store(const Store& store, const RunResult& result, bool quiet) {
  if (store.damaged())
    std::cerr << "store: " << store.damaged() << " damaged result" << (store.damaged() == 1 ? " was" : "s were") << " removed and made again\n";
  if (const std::string fault = store.fault(); !fault.empty())
    std::cerr << "store: from some result on nothing was kept (" << fault << "); the run and what is kept already are whole\n";
  if (quiet) return;
  std::size_t made = 0, reused = 0;
  for (const StepTime& time : result.times) made += time.items, reused += time.remembered;
  std::cerr << "store: " << reused << " results reused, " << made << " made\n";
}

void run(const Options& options) {
  const Registry steps = installed_steps();
  const Plan plan = read_pipeline(options.pipeline.file, options.pipeline.overlay, steps);
  preflight(plan, steps);
  require_log_elsewhere(options);
  remove_staging_when_interrupted();
  std::unique_ptr<Store> store;
  if (!options.store.empty()) store = std::make_unique<Store>(options.store);
  OutputFolder folder(options.output);
  if (!options.log.empty()) begin_log(options.log);
  try {
    Console console(options.quiet, options.log);
    RunOptions run_options;
    run_options.threads = options.threads;
    run_options.store = store.get(), run_options.fresh = options.fresh;
    const RunResult result = run_plan(plan, steps, run_options, console);
    folder.fill(plan, result);
    if (store) say_of_store(*store, result, options.quiet);
    if (options.quiet) print_weak(std::cerr, result, false);
    else print_summary(std::cout, plan, result, options.output, options.times);
  } catch (const Error& e) {
    std::cerr << "plumb: " << e.what() << "\n";
    throw CLI::RuntimeError(3);
  }
}

}  // namespace

void add_run(CLI::App& app) {
  auto* command = app.add_subcommand("run", "Checks and runs a pipeline and leaves its results in a folder");
  auto options = std::make_shared<Options>();
  options->pipeline.add_to(*command);
  options->pipeline.overlay.needs_files = true;
  command->add_option("-o,--output", options->output, "Folder for the results; an earlier run in it is replaced")->required();
  command->add_option("--threads", options->threads, "Threads to use; 0 for as many as the machine has")->check(CLI::Range(0, 1024))->capture_default_str();
  command->add_option("--store", options->store, "Folder in which results are kept, and from which a later run takes what did not change")
      ->envname("PLUMB_STORE");
  command->add_flag("--fresh", options->fresh, "Take nothing from the store; keep what is made");
  command->add_flag("--quiet", options->quiet, "Only warnings and errors");
  command->add_flag("--times", options->times, "Show the time that each step took");
  command->add_option("--log", options->log, "Also write progress and notes, with the time of day, to this file");
  command->footer(
      "Example: plumb run pipelines/tang2024.yaml --preset pipelines/presets/car_64line.yaml --set input=DIR -o OUT\n"
      "The results are the same for any number of threads. No results are left behind when a run fails or is interrupted.");
  command->callback([options] { run(*options); });
}

}  // namespace plumb::command
