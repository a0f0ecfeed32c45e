/// plumb compare: a pipeline against variants of it, on the same inputs.

#include <algorithm>
#include <iostream>
#include <set>

#include "cache_size.hpp"
#include "command_line.hpp"
#include "console.hpp"
#include "exit_guard.hpp"
#include "interrupt.hpp"
#include "pipeline_options.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/file_name.hpp"
#include "plumb/engine/preflight.hpp"
#include "plumb/engine/record/output_folder.hpp"
#include "plumb/engine/record/quoted.hpp"
#include "plumb/pipeline/yaml/load.hpp"
#include "plumb/pipeline/yaml/value.hpp"
#include "plumb/slam/io/trajectory_text.hpp"
#include "plumb/slam/report/comparison.hpp"
#include "side_file.hpp"
#include "store_option.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path pipeline, output;
  std::vector<std::string> variants, sets;
  std::vector<fs::path> inputs;
  ComparedFigures figures;
  unsigned threads = 0;
  bool quiet = false, json = false;
  StoreOption store{.otherwise = "none"};
  CacheSize cache_size;
};

/// A pipeline with what is laid over it for one input, ready to run.
struct Run {
  Plan plan;
  std::unique_ptr<OutputFolder> folder;  ///< none: nothing is kept
};

struct Variant {
  std::string name;
  fs::path pipeline;
  std::vector<fs::path> presets;
  bool alone = false;  ///< a pipeline of its own, which --set does not reach
};

/// A file that extends nothing is a pipeline of its own, any other is laid over the one that is
/// compared. One that cannot be read is told later.
bool stands_alone(const fs::path& file, const fs::path& pipeline) {
  pipeline::Diagnostics ignored;
  return pipeline::read_chain(file, pipeline, {}, ignored).links.size() == 1;
}

std::vector<Variant> variants_of(const Options& options, const Plan& pipeline) {
  std::vector<Variant> variants{{pipeline.name, options.pipeline, {}, false}};
  for (const std::string& option : options.variants) {
    const auto equals = option.find('=');
    const std::string name = option.substr(0, equals);
    if (std::any_of(variants.begin(), variants.end(),
                    [&](const Variant& v) { return v.name == name; }))
      throw Error("--variant " + option + ": there is a '" + name + "' already" +
                  (name == pipeline.name ? ", the pipeline as it is" : "") +
                  "; give each variant a name of its own");
    const fs::path file = option.substr(equals + 1);
    if (stands_alone(file, options.pipeline))
      variants.push_back({name, file, {}, true});
    else
      variants.push_back({name, options.pipeline, {file}, false});
  }
  return variants;
}

/// A name for each input, of which no two are the same: what its path ends with.
std::vector<std::string> names_of(const std::vector<fs::path>& inputs) {
  std::vector<std::string> names;
  std::set<std::string> used;
  for (const fs::path& input : inputs) {
    fs::path path = fs::absolute(input).lexically_normal();
    if (path.filename().empty()) path = path.parent_path();
    std::string name = path.filename().string();
    for (int k = 2; !used.insert(name).second; ++k)
      name = path.filename().string() + "_" + std::to_string(k);
    names.push_back(name);
  }
  return names;
}

/// Whether the command line sets a parameter itself.
bool is_set(const Options& options, const std::string& name) {
  return std::any_of(options.sets.begin(), options.sets.end(),
                     [&](const std::string& set) { return set.starts_with(name + "="); });
}

/// What an input sets: itself, or the log in it; and what lies beside that the pipeline asks for:
/// the truth, the plan, and as `estimate` what another program of the variant's name made of it,
/// NAME.tum.
std::vector<std::string> sets_of(const fs::path& input, const Plan& pipeline,
                                 const std::string& variant) {
  const auto declares = [&](const char* name) {
    return std::any_of(pipeline.settings.begin(), pipeline.settings.end(),
                       [&](const auto& s) { return s.name == name; });
  };
  if (!declares("input"))
    throw Error(
        pipeline.files.front() +
        ": has no parameter 'input' that --input could set; declare one under 'parameters'");
  if (!fs::exists(input))
    throw Error("--input " + input.string() +
                ": there is no such file or folder; give a log, or the folder of a sequence");
  const auto set = [](const std::string& name, const fs::path& file) {
    return name + "=" + pipeline::dollars_doubled(file.string());
  };
  if (!fs::is_directory(input)) return {set("input", input)};
  const auto log = input / "log.clf";
  std::vector<std::string> sets{set("input", fs::exists(log) ? log : input)};
  for (const auto& [name, file] : {std::pair<const char*, std::string>{"truth", "truth.tum"},
                                   {"plan", "plan.txt"},
                                   {"estimate", variant + ".tum"}})
    if (declares(name) && fs::exists(input / file)) sets.push_back(set(name, input / file));
  return sets;
}

void require_timed(const std::vector<std::string>& timed, const Plan& pipeline) {
  if (timed == ComparedFigures{}.timed) return;
  for (const std::string& first : timed)
    if (std::ranges::none_of(pipeline.steps, [&](const PlannedStep& step) {
          return step.description->name.starts_with(first);
        }))
      throw Error(
          "--time " + first + ": no step of " + pipeline.files.front() +
          " uses one whose name begins so; give the beginning of a name that stands behind 'use'");
}

/// The pipeline's name and those of the inputs become folders', and the former also names what lies
/// beside an input.
void require_good_names(const Options& options, const Plan& pipeline,
                        const std::vector<std::string>& inputs) {
  if (const std::string fault = fault_of_file_name(pipeline.name); !fault.empty())
    throw Error(pipeline.files.front() + ": its name " + in_quotes(pipeline.name) +
                ", of which compare makes a folder, " + fault);
  if (options.output.empty()) return;
  for (std::size_t k = 0; k < inputs.size(); ++k)
    if (const std::string fault = fault_of_file_name(inputs[k]); !fault.empty())
      throw Error("--input " + options.inputs[k].string() + ": " + in_quotes(inputs[k]) +
                  ", of which compare makes a folder in -o, " + fault);
}

void require_different_inputs(const Options& options) {
  for (std::size_t k = 0; k < options.inputs.size(); ++k)
    for (std::size_t n = 0; n < k; ++n)
      if (fs::weakly_canonical(options.inputs[k]) == fs::weakly_canonical(options.inputs[n]))
        throw Error("--input " + options.inputs[k].string() +
                    ": is given twice, which would make the confidence look better than it is; "
                    "leave one out");
  if (is_set(options, "input"))
    throw UsageError("--set input=...: --input sets it; leave one of them out");
}

/// The runs of a variant on all inputs, in their order.
std::vector<Run> runs_of(const Variant& variant, const Options& options, const Registry& steps) {
  std::vector<Run> runs;
  for (const fs::path& input : options.inputs) {
    const Plan open = read_pipeline(variant.pipeline, {variant.presets, {}, true, false}, steps);
    auto sets = sets_of(input, open, variant.name);
    if (!variant.alone) {
      std::erase_if(sets, [&](const std::string& set) {
        return is_set(options, set.substr(0, set.find('=')));
      });
      sets.insert(sets.end(), options.sets.begin(), options.sets.end());
    }
    runs.push_back(
        {read_pipeline(variant.pipeline, {variant.presets, sets, false, true}, steps), nullptr});
    say_warnings(runs.back().plan);
  }
  return runs;
}

/// What all runs share.
struct Shared {
  const Options& options;
  const Registry& steps;
  Store* store;
  SizeBound* bound;
  bool settled = true;  ///< what was put in place is as it should be
};

/// Makes one run and fills its folder.
RunResult result_of(Run& run, Shared& shared) {
  Console console(true, "");
  RunOptions run_options;
  run_options.threads = shared.options.threads;
  run_options.store = shared.store;
  run_options.store_bound = shared.bound;
  const RunRecord record = run.folder ? record_of(run.plan, false) : RunRecord();
  RunResult result = run_plan(run.plan, shared.steps, run_options, console);
  if (const std::string unsettled = run.folder ? run.folder->fill(record, result) : "";
      !unsettled.empty()) {
    std::cerr << "plumb: " << unsettled << "\n";
    shared.settled = false;
  }
  return result;
}

void compare(const Options& options) {
  options.store.require_one_meaning();
  options.cache_size.require_one_meaning(options.store);
  const Registry steps = installed_steps();
  const Plan pipeline = read_pipeline(options.pipeline, {{}, options.sets, true, false}, steps);
  say_warnings(pipeline);
  const auto variants = variants_of(options, pipeline);
  const auto input_names = names_of(options.inputs);
  require_good_names(options, pipeline, input_names);
  require_different_inputs(options);
  require_timed(options.figures.timed, pipeline);

  // All that can be refused is refused before the first run.
  std::vector<std::vector<Run>> runs;
  std::vector<std::string> variant_names;
  for (const Variant& variant : variants) {
    runs.push_back(runs_of(variant, options, steps));
    variant_names.push_back(variant.name);
  }
  const ExitGuard while_loading;
  for (const auto& of_variant : runs) preflight(of_variant.front().plan, steps);
  remove_staging_when_interrupted();
  const auto place = [&](std::size_t v, std::size_t k) {
    return options.output / variants[v].name / input_names[k];
  };
  const auto for_each_place = [&](const auto& act) {
    for (std::size_t v = 0; v < variants.size() && !options.output.empty(); ++v)
      for (std::size_t k = 0; k < input_names.size(); ++k) act(v, k);
  };
  for_each_place([&](std::size_t v, std::size_t k) { require_apart(options.store, place(v, k)); });
  const std::unique_ptr<Store> store = options.store.open();
  for_each_place([&](std::size_t v, std::size_t k) {
    runs[v][k].folder = std::make_unique<OutputFolder>(place(v, k));
  });

  const ExitGuard while_running;
  BoundedCache cache(options.cache_size, store.get());
  Shared shared{options, steps, store.get(), cache.bound()};
  std::vector<std::vector<std::vector<Number>>> figures(variants.size());
  for (std::size_t k = 0; k < input_names.size(); ++k)
    for (std::size_t v = 0; v < variants.size(); ++v) {
      Run& run = runs[v][k];
      try {
        const RunResult result = result_of(run, shared);
        figures[v].push_back(figures_of(run.plan, result, options.figures, v == 0));
        if (!options.quiet)
          std::cerr << variants[v].name << " on " << input_names[k] << ": "
                    << io::fixed(result.seconds, 1) << " s\n";
      } catch (const std::exception& e) {
        std::cerr << "plumb: variant '" << variants[v].name << "' on " << options.inputs[k].string()
                  << ": " << e.what() << "\n";
        throw ExitWith{exit_failed};
      }
    }
  cache.end(options.quiet);
  if (store) say_faults(*store);
  const Comparison comparison = plumb::compare(variant_names, input_names, figures);
  std::cout << (options.json ? comparison_json(comparison) + "\n" : comparison_table(comparison));
  if (!shared.settled) throw ExitWith{exit_unsettled};
}

/// What `--variant` takes; the name becomes a folder's.
std::string fault_of_variant(const std::string& option) {
  const auto equals = option.find('=');
  const std::string name = option.substr(0, equals);
  if (equals == std::string::npos || equals + 1 == option.size() || name.empty())
    return "expected NAME=PRESET, as in unimproved=presets/zhang2023_unimproved.yaml, not '" +
           option + "'";
  const std::string fault = fault_of_file_name(name);
  return fault.empty() ? "" : in_quotes(name) + " " + fault;
}

}  // namespace

void add_compare(Command& program) {
  Command command = program.add_subcommand(
      "compare",
      "Runs a pipeline and variants of it on the same inputs and compares their numbers");
  auto options = std::make_shared<Options>();
  command.add_option("PIPELINE", options->pipeline, "A pipeline or a preset (YAML)").required();
  command
      .add_option("--variant", options->variants,
                  "NAME=FILE: the pipeline with that preset, or another pipeline by itself (--set "
                  "does not reach it); may be given again")
      .required()
      .one_value_each()
      .check(fault_of_variant);
  command
      .add_option("--input", options->inputs,
                  "What the parameter 'input' is set to: a log, or a sequence's folder, of which "
                  "log.clf, truth.tum and "
                  "plan.txt are used where they are there; may be given again")
      .required()
      .one_value_each();
  command
      .add_option("--set", options->sets,
                  "A parameter, a row or a step's parameter, in all runs of the pipeline and its "
                  "presets; a '$' in it is written '$$'; may be given again")
      .one_value_each()
      .check(fault_of_set);
  command
      .add_option("--metric", options->figures.metrics,
                  "Numbers to compare, as STEP.NUMBER with * and ?; may be given again. Without: "
                  "those of the steps error, "
                  "map_error and relation_error, of the last stage that they measure")
      .one_value_each();
  command
      .add_option("--time", options->figures.timed,
                  "Steps whose time and iterations are compared: how their 'use' begins; may be "
                  "given again")
      .one_value_each()
      .capture_default_str();
  command.add_option("-o,--output", options->output,
                     "Keeps each run's results in OUTPUT/VARIANT/INPUT");
  command
      .add_option("--threads", options->threads, "Threads to use; 0 for as many as the machine has")
      .range(0, 1024)
      .capture_default_str();
  options->store.add_to(command);
  options->cache_size.add_to(command);
  command.add_flag("--json", options->json, "One JSON object with every value instead of a table");
  command.add_flag("--quiet", options->quiet, "No line for each run");
  command.footer(
      "The columns are means over the inputs; 'less by' is how much less the pipeline has than the "
      "variant, with the 95 % confidence\n"
      "of the inputs' differences. Times are CPU seconds: of those steps, and of all.\n"
      "Exit 1 when anything is refused before the first run, 3 when a run fails; it is said "
      "which.\n"
      "What is taken from a cache counts as no time, so that by itself compare uses none.\n\n"
      "  plumb compare pipelines/zhang2023.yaml --variant "
      "unimproved=pipelines/presets/zhang2023_unimproved.yaml --input DIR1 --input DIR2");
  command.callback([options] { compare(*options); });
}

}  // namespace plumb::command
