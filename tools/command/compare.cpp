/// plumb compare: a pipeline against variants of it, on the same inputs.

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "cache_size.hpp"
#include "command.hpp"
#include "command_line.hpp"
#include "compared_runs.hpp"
#include "exit_guard.hpp"
#include "experiment_options.hpp"
#include "interrupt.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/observe/event_file.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/slam/experiment/outcome.hpp"
#include "replaced_file.hpp"
#include "side_file.hpp"
#include "store_option.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace {

namespace fs = std::filesystem;
using experiment::Experiment, experiment::Outcome, experiment::Verdict;

struct Options {
  ExperimentOptions experiment;
  fs::path output, baseline, events;
  std::vector<fs::path> save;
  std::string format = "table";
  unsigned threads = 0;
  bool quiet = false, json = false, fail_fast = false;
  StoreOption store{
      .otherwise = "none",
      .otherwise_of = "none; of an experiment's file PLUMB_CACHE_DIR, or ~/.cache/plumb"};
  CacheSize cache_size;
};

/// The ending of a file says how it is written.
std::string text_of(const Outcome& outcome, const std::string& format) {
  if (format == "json") return outcome_json(outcome) + "\n";
  if (format == "csv") return outcome_csv(outcome);
  if (format == "svg") return outcome_svg(outcome);
  return format == "markdown" ? outcome_markdown(outcome) : outcome_table(outcome);
}

std::string format_of(const fs::path& file) {
  const std::string ending = file.extension().string();
  for (const auto& [known, format] : {std::pair<const char*, const char*>{".json", "json"},
                                      {".csv", "csv"},
                                      {".md", "markdown"},
                                      {".svg", "svg"},
                                      {".txt", "table"}})
    if (ending == known) return format;
  throw UsageError(
      "--save " + file.string() +
      ": its ending says how it is written, and must be .json, .csv, .md, .svg or .txt");
}

/// What of the experiment's the baseline decides, where nobody says otherwise.
void take_over(Experiment& experiment, const Outcome& baseline) {
  if (experiment.primary.empty()) experiment.primary = baseline.rules.primary;
}

Outcome outcome_of(const Options& options, const Experiment& experiment, const ComparedRuns& runs) {
  Outcome outcome;
  outcome.name = experiment.name;
  outcome.about = experiment.about;
  outcome.measured = runs.measured();
  outcome.replicates = experiment.replicates;
  outcome.rules.margin = experiment.margin;
  outcome.rules.higher_is_better = experiment.higher_is_better;
  outcome.rules.primary = experiment.primary.empty()
                              ? experiment::usual_primary(numbers_in(outcome.measured))
                              : experiment.primary;
  outcome.baseline = options.baseline.string();
  for (const auto& variant : runs.variants()) outcome.swept.push_back(variant.swept);
  return outcome;
}

void require_comparable(const std::optional<Outcome>& baseline, const Outcome& outcome) {
  if (!baseline) return;
  if (const std::string why = not_comparable(*baseline, outcome); !why.empty())
    throw NothingMeasured("--baseline " + outcome.baseline + ": cannot be compared with: " + why);
}

/// What of the baseline's nothing is held against now: it may be meant.
void say_left_out(const std::optional<Outcome>& baseline, const Outcome& outcome) {
  if (!baseline) return;
  if (const auto left_out = only_in(*baseline, outcome); !left_out.empty())
    std::cerr << "--baseline " << outcome.baseline
              << ": also has what is not compared now: " << pipeline::joined(left_out) << "\n";
}

void save(const Options& options, const Outcome& outcome, bool& settled) {
  for (const fs::path& file : options.save) {
    try {
      replace_file(file, text_of(outcome, format_of(file)), {}, "--save");
    } catch (const Error& e) {
      std::cerr << e.what() << "; all runs are done\n";
      settled = false;
    }
  }
}

/// The last word on standard error, and the exit code that goes with it.
int conclusion(const Outcome& outcome, bool settled) {
  const auto& measured = outcome.measured;
  const experiment::Judged* primary = outcome.primary();
  if (outcome.any(Verdict::worse)) {
    for (const auto& contrast : primary->contrasts)
      if (contrast.verdict == Verdict::worse) {
        std::cerr << "plumb: worse: "
                  << sentence(*primary, contrast, reference_of(outcome), measured.inputs.size())
                  << "\n";
        break;
      }
    return exit_worse;
  }
  if (const std::size_t failures = measured.failures(); failures > 0) {
    const auto first = std::find_if(measured.cells.begin(), measured.cells.end(),
                                    [](const auto& cell) { return !cell.failure.empty(); });
    std::cerr << "plumb: " << failures << " of " << counted(measured.cells.size(), "runs")
              << " failed, the first by: " << first->failure << "\n";
    return exit_failed;
  }
  if (!primary) {
    std::cerr << "plumb: nothing was compared: no two "
              << (outcome.baseline.empty() ? "variants" : "outcomes") << " have the number '"
              << outcome.rules.primary << "', which decides; name another with --primary\n";
    return exit_nothing;
  }
  if (settled) return 0;
  std::cerr
      << "plumb: all runs are done, but not all of their results are as they should be; it is "
         "said above which\n";
  return exit_unsettled;
}

void require_places(const Options& options, const ComparedRuns& runs) {
  if (options.output.empty()) return;
  for (const fs::path& place : runs.places(options.output)) {
    require_apart(options.store, place);
    require_elsewhere({{"--events", options.events, "events", EventLines::mark}}, place);
  }
}

/// Makes the runs and says what they took from the cache.
void make(const Options& options, ComparedRuns& runs, Store* store) {
  BoundedCache cache(options.cache_size, store);
  std::unique_ptr<EventLines> events;
  if (!options.events.empty()) {
    begin({"--events", options.events, "events", EventLines::mark});
    events = std::make_unique<EventLines>(options.events);
  }
  RunsOptions all;
  all.threads = options.threads;
  all.store = store, all.bound = cache.bound(), all.fresh = options.store.refresh;
  all.quiet = options.quiet, all.fail_fast = options.fail_fast;
  all.events = events.get();
  runs.make(all);
  cache.end(options.quiet);
  if (store) say_faults(*store);
  if (events)
    if (const std::string fault = events->fault(); !fault.empty()) std::cerr << fault << "\n";
  if (const std::size_t stamps = runs.stamps_left_out(); stamps > 0)
    std::cerr << "errors are taken at the stamps that all variants have: up to "
              << counted(stamps, "stamps") << " of a trajectory are left out\n";
}

int compare(Options& options) {
  for (const fs::path& file : options.save) format_of(file);
  if (options.experiment.of_file()) options.store.otherwise.clear();
  options.store.require_one_meaning();
  options.cache_size.require_one_meaning(options.store);
  if (options.store.refresh && options.store.none())
    throw UsageError("--refresh: makes all anew to keep it, and nothing is kept; give --cache-dir");
  Experiment experiment = options.experiment.asked();
  std::optional<Outcome> baseline;
  if (!options.baseline.empty()) {
    baseline = experiment::outcome_of_json(options.baseline);
    take_over(experiment, *baseline);
  }
  if (experiment.variants.empty() && experiment.axes.empty() && !baseline)
    throw UsageError("nothing to compare with: give --variant, --sweep or --baseline");
  const Registry steps = installed_steps();

  // All that can be refused is refused before the first run.
  ComparedRuns runs(experiment, steps);
  const ExitGuard while_loading;
  runs.preflight_all();
  remove_staging_when_interrupted();
  require_places(options, runs);
  const std::unique_ptr<Store> store = options.store.open();
  if (!options.output.empty()) runs.keep_in(options.output);

  const ExitGuard while_running;
  try {
    if (baseline && !experiment.primary.empty())
      require_comparable(baseline, outcome_of(options, experiment, runs));
    make(options, runs, store.get());
    Outcome outcome = outcome_of(options, experiment, runs);
    require_comparable(baseline, outcome);
    say_left_out(baseline, outcome);
    outcome.numbers = baseline ? judge_against(baseline->measured, outcome.measured, outcome.rules)
                               : judge(outcome.measured, outcome.rules);
    std::cout << text_of(outcome, options.json ? "json" : options.format);
    bool settled = runs.settled();
    save(options, outcome, settled);
    return conclusion(outcome, settled);
  } catch (const NothingMeasured& e) {
    std::cerr << "plumb: nothing was measured: " << e.what() << "\n";
    return exit_nothing;
  } catch (const FailedFast& e) {
    std::cerr << "plumb: " << e.what() << "\n";
    return exit_failed;
  }
}

void add_reports(Command command, Options& options) {
  command.add_option("--format", options.format, "How the result is printed")
      .one_of({"table", "csv", "json", "markdown"})
      .capture_default_str();
  command.add_flag("--json", options.json, "As --format json");
  command
      .add_option(
          "--save", options.save,
          "Also writes the result to a file .json, .csv, .md, .svg (a plot) or .txt; may be "
          "given again")
      .one_value_each();
  command.add_option("--events", options.events,
                     "Also write all that happens to this file: a JSON object a line");
  command.add_flag("--quiet", options.quiet, "No line for each run");
}

}  // namespace

void add_compare(Command& program) {
  Command command = program.add_subcommand(
      "compare", "Runs a pipeline and variants of it on the same inputs and says which is better");
  auto options = std::make_shared<Options>();
  options->experiment.add_to(command);
  command.add_option("--baseline", options->baseline,
                     "A result that --save FILE.json wrote: each variant against what it was then, "
                     "by its name, on inputs of the same name, number of files and bytes");
  command.add_option("-o,--output", options->output,
                     "Keeps each run's results in OUTPUT/VARIANT/INPUT, of replicates in "
                     "replicate_N there");
  command.add_flag("--fail-fast", options->fail_fast, "The first run that fails ends it");
  command
      .add_option("--threads", options->threads, "Threads to use; 0 for as many as the machine has")
      .range(0, 1024)
      .capture_default_str();
  options->store.add_to(command);
  options->store.add_usage_to(command);
  options->cache_size.add_to(command);
  add_reports(command, *options);
  command.footer(
      "The first variant is the pipeline as it is. A line says of each other one how much lower or "
      "higher it is, the 95 % interval,\n"
      "and the verdict: better, worse, equivalent, not shown, or large, not proven. From six "
      "inputs on (of one variant; 7 of two, 10 of 19:\n"
      "with m variants and n inputs 2m / 2^n must be at most 5 %) it holds for inputs of which "
      "these are a sample; with fewer than six it is\n"
      "said of these data, and not corrected for the number of variants. A run that fails is "
      "counted and shown, and the others go on.\n"
      "An experiment's file uses the cache by itself, so that what is common is made once and a "
      "killed one goes on; times of what came from\n"
      "a cache, also by another variant, are not compared: --cache-dir none measures them.\n"
      "Exit 0 when nothing is worse; 1 when anything is refused before the first run; 3 when a run "
      "failed; 5 when a variant is worse in the\n"
      "number that decides; 6 when nothing could be measured or compared, or a variant or an input "
      "is not in the baseline. Of several the\n"
      "first of 5, 3, 6.\n\n"
      "  plumb compare pipelines/zhang2023.yaml --variant "
      "unimproved=pipelines/presets/zhang2023_unimproved.yaml --input DIR1 --input DIR2\n"
      "  plumb compare pipelines/plumb.yaml --sweep voxel_size=0.3m,0.4m --input DIR --replicates "
      "3\n"
      "  plumb compare pipelines/experiments/unimproved.yaml --input DIR --save result.json");
  command.callback([options] {
    if (const int code = compare(*options); code != 0) throw ExitWith{code};
  });
}

}  // namespace plumb::command
