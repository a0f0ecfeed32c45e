/// plumb run: checks, runs, reports.

#include <iostream>
#include <memory>

#include "cache_size.hpp"
#include "command_line.hpp"
#include "console.hpp"
#include "executor_options.hpp"
#include "exit_guard.hpp"
#include "interrupt.hpp"
#include "pipeline_options.hpp"
#include "plumb/data/amount.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/io/file_identity.hpp"
#include "plumb/engine/observe/event_file.hpp"
#include "plumb/engine/preflight.hpp"
#include "plumb/engine/record/output_folder.hpp"
#include "plumb/engine/run/runner.hpp"
#include "side_file.hpp"
#include "store_option.hpp"
#include "summary.hpp"
#include "untrusted.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace {

struct Options {
  PipelineOptions pipeline;
  std::filesystem::path output, locked, log, events, trace;
  StoreOption store;
  CacheSize cache_size;
  ExecutorOptions executor;
  Untrusted untrusted;
  std::string memory;
  unsigned threads = 0;
  bool quiet = false, times = true, verify_inputs = false, explain = false;
};

/// What runs, and the record of it.
struct Planned {
  Plan plan;
  RunRecord record;
};

/// The pipeline of a record, if all that it depends on is as it was then.
Planned locked(const Options& options, const Registry& steps) {
  const std::string name = options.locked.string();
  const RunRecord then = read_lock(options.locked);
  RunRecord now = record_now(then, steps, options.verify_inputs);
  std::string all;
  for (const std::string& sentence : differences(then, now))
    all += (all.empty() ? "" : "\nplumb: ") + name + ": " + sentence;
  if (!all.empty()) throw Error(all);
  Plan plan = read_resolved(then.pipeline, name, steps);
  plan.name = then.name;
  plan.resolved = then.pipeline;
  if (!describes(now, plan))
    throw Error(name +
                ": its steps or inputs are not those of its pipeline; the record is damaged: run "
                "the pipeline itself to get a new one");
  return {std::move(plan), std::move(now)};
}

/// Whoever listens to the run.
class Listeners {
 public:
  Listeners(const Options& options) : console_(options.quiet, options.log) {
    if (!options.events.empty()) files_.push_back(std::make_unique<EventLines>(options.events));
    if (!options.trace.empty()) files_.push_back(std::make_unique<TraceFile>(options.trace));
  }
  Observers all() {
    std::vector<Observer*> list{&console_};
    for (const auto& file : files_) list.push_back(file.get());
    return Observers(list);
  }
  void say_of_files(const std::filesystem::path& log) {
    if (const std::string fault = console_.log_fault(); !fault.empty())
      std::cerr << log.string() << ": is not whole: " << fault << "; the results are whole\n";
    for (const auto& file : files_)
      if (const std::string fault = file->fault(); !fault.empty())
        std::cerr << fault << "; the results are whole\n";
  }

 private:
  Console console_;
  std::vector<std::unique_ptr<EventFile>> files_;
};

void say_of_store(const Store& store, const RunResult& result, bool quiet) {
  say_faults(store);
  if (quiet) return;
  std::size_t made = 0, reused = 0;
  for (const StepTime& time : result.times) made += time.items, reused += time.remembered;
  std::cerr << "cache: " << counted(reused, "results reused") << ", " << made << " made\n";
}

constexpr std::uint64_t least_memory = std::uint64_t{256} << 20;

std::uint64_t memory_of_text(const std::string& text) {
  if (text.empty()) return 0;
  const std::uint64_t bytes = usage([&] { return bytes_of_text("--memory", text); });
  if (bytes < least_memory)
    throw UsageError("--memory " + text + ": is too little to run in; give 256MiB or more");
  return bytes;
}

/// An empty value is a mistake of a script: taken as none it would run without its bound, or into
/// the user's cache.
void require_values(const Command& command) {
  if (const auto option = command.option_without_value())
    throw UsageError(*option + ": its value is empty; give one, or leave the option out");
}

/// What leaves memory, and what workers make, goes through the cache.
void require_store(const Options& options, const Store* store) {
  if (store) return;
  const std::string executor = "--executor " + options.executor.where();
  const char* needs = options.executor.needs_store() ? executor.c_str()
                      : !options.memory.empty()      ? "--memory"
                      : options.explain              ? "--explain"
                                                     : nullptr;
  if (needs)
    throw UsageError(std::string("a cache is needed for ") + needs +
                     (options.store.no_cache ? ", and --no-cache is given; leave one of them out"
                                             : ", but there is none; give --cache-dir DIR"));
}

std::vector<SideFile> side_files_of(const Options& options) {
  return {{"--log", options.log, "log", log_mark},
          {"--events", options.events, "events", EventLines::mark},
          {"--trace", options.trace, "trace", TraceFile::mark}};
}

/// What is said of a run whose results are in place.
void report(const Options& options, const Plan& plan, const RunResult& result, const Store* store) {
  if (options.explain)
    for (const Explained& step : result.explained) std::cout << step.text() << "\n";
  if (store) say_of_store(*store, result, options.quiet);
  if (options.quiet)
    print_weak(std::cerr, result, false);
  else
    print_summary(std::cout, plan, result, options.output, options.times);
}

void run(Options& options) {
  options.store.require_one_meaning();
  options.cache_size.require_one_meaning(options.store);
  const std::uint64_t memory = memory_of_text(options.memory);
  options.executor.require_one_meaning(options.threads, memory);
  if (options.store.none()) require_store(options, nullptr);
  options.untrusted.before_reading(options.pipeline);
  if (options.verify_inputs) io::identify_files_by(io::FileIdentity::content);
  const Registry steps = options.untrusted.steps();
  auto [plan, record] =
      options.locked.empty()
          ? Planned{read_pipeline(options.pipeline.file, options.pipeline.overlay, steps), {}}
          : locked(options, steps);
  if (options.locked.empty()) say_warnings(plan);  // a record is never rewritten
  options.untrusted.before_running(plan, steps, {options.output, options.store.folder()});
  const ExitGuard while_loading;
  preflight(plan, steps);
  const std::vector<SideFile> side_files = side_files_of(options);
  require_elsewhere(side_files, options.output);
  require_apart(options.store, options.output);
  remove_staging_when_interrupted();
  const std::unique_ptr<Store> store = options.store.open();
  require_store(options, store.get());
  BoundedCache cache(options.cache_size, store.get());
  const auto executor = options.executor.make(options.threads, memory, options.verify_inputs,
                                              options.store.refresh, store.get());
  if (options.locked.empty()) record = record_of(plan, options.verify_inputs);
  OutputFolder folder(options.output);
  for (const SideFile& file : side_files)
    if (!file.file.empty()) begin(file);
  const ExitGuard while_running;
  std::string unsettled;
  try {
    Listeners listeners(options);
    Observers all = listeners.all();
    RunOptions run_options;
    run_options.threads = options.threads;
    run_options.store = store.get(), run_options.fresh = options.store.refresh;
    run_options.store_bound = cache.bound();
    run_options.memory = memory, run_options.executor = executor.get();
    const RunResult result = run_plan(plan, steps, run_options, all);
    if (const std::string changed = changed_input(record); !changed.empty())
      throw Error(
          changed + ", so that the results are of no one input and are not put in place; " +
          "run it again (with --refresh where files got back their former sizes and times)");
    unsettled = folder.fill(std::move(record), result);
    listeners.say_of_files(options.log);
    cache.end(options.quiet);
    report(options, plan, result, store.get());
  } catch (const std::exception& e) {
    std::cerr << "plumb: " << e.what() << "\n";
    throw ExitWith{exit_failed};
  }
  if (unsettled.empty()) return;
  std::cerr << "plumb: " << unsettled << "\n";
  throw ExitWith{exit_unsettled};
}

/// What the run tells, on the screen and in files beside the results.
void add_reports(Command& command, Options& options) {
  command.add_flag("--quiet", options.quiet, "Only warnings and errors");
  command.add_flag("--times,!--no-times", options.times,
                   "Show the time and memory that each step took (unless --no-times or --quiet)");
  command.add_option("--log", options.log,
                     "Also write progress and notes, with the time of day, to this file");
  command.add_option(
      "--events", options.events,
      "Also write all that happens to this file, as it happens: a JSON object a line");
  command.add_option(
      "--trace", options.trace,
      "Also write which item was made when and by which thread, for ui.perfetto.dev");
}

/// --locked, which stands for a pipeline and all that goes with one.
void add_locked(Command& command, Options& options) {
  command.add_flag("--verify-inputs", options.verify_inputs,
                   "Read the inputs' files to know them by content, not by size and time alone");
  command.get_option("PIPELINE").required(false);
  command
      .add_option("--locked", options.locked,
                  "Repeat the run of this run.lock.yaml, if all that it depends on is as it was; "
                  "takes no PIPELINE")
      .excludes("PIPELINE")
      .excludes("--preset")
      .excludes("--set");
  command.get_option("--untrusted")
      .excludes("--locked")
      .excludes("--isolate")
      .excludes("--executor")
      .excludes("--executor-profile");
}

}  // namespace

void add_run(Command& program) {
  Command command = program.add_subcommand(
      "run", "Checks and runs a pipeline and leaves its results in a folder");
  auto options = std::make_shared<Options>();
  options->pipeline.add_to(command);
  options->pipeline.overlay.needs_files = true;
  command
      .add_option("-o,--output", options->output,
                  "Folder for the results; an earlier run in it is replaced, if all in it is as "
                  "the run left it")
      .required();
  command
      .add_option("--threads", options->threads, "Threads to use; 0 for as many as the machine has")
      .range(0, 1024)
      .capture_default_str();
  options->store.add_to(command);
  options->store.add_usage_to(command);
  options->cache_size.add_to(command);
  command.add_flag("--explain", options->explain,
                   "Say of each step whether its results were reused, and the first thing that "
                   "differs from the last run");
  command.add_option(
      "--memory", options->memory,
      "Bound of resident memory, such as 2GiB: what does not fit waits in the cache, and steps run "
      "one after the other");
  options->executor.add_to(command);
  options->untrusted.add_to(command);
  add_reports(command, *options);
  add_locked(command, *options);
  command.footer(
      "Example: plumb run pipelines/plumb.yaml --set input=DIR -o OUT\n"
      "The results are the same for any number of threads. No results are left behind when a run "
      "fails or is interrupted.");
  command.callback([options, command] {
    require_values(command);
    if (options->locked.empty() && options->pipeline.file.empty())
      throw UsageError("PIPELINE or --locked is required; `plumb run --help` says what there is");
    run(*options);
  });
}

}  // namespace plumb::command
