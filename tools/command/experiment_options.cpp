#include "experiment_options.hpp"

#include <algorithm>
#include <limits>

#include "command_line.hpp"
#include "pipeline_options.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/file_name.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/engine/record/quoted.hpp"
#include "plumb/pipeline/yaml/foreign_file.hpp"
#include "plumb/pipeline/yaml/parts.hpp"
#include "plumb/pipeline/yaml/value.hpp"
#include "plumb/slam/report/figures.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace fs = std::filesystem;
namespace {

using experiment::Experiment, experiment::Input, experiment::SweepBy, experiment::Variant;

/// What `--variant` takes; the name becomes a folder's.
std::string fault_of_variant(const std::string& option) {
  const auto equals = option.find('=');
  const std::string name = option.substr(0, equals);
  if (equals == std::string::npos || equals + 1 == option.size() || name.empty())
    return "expected NAME=FILE or NAME='PARAMETER=VALUE', as in coarse='voxel_size=0.5m', not '" +
           option + "'";
  const std::string fault = fault_of_file_name(name);
  return fault.empty() ? "" : plumb::in_quotes(name) + " " + fault;
}

/// A file; or words parted by blanks that are files or PARAMETER=VALUE.
Variant variant_of(const std::string& option, const fs::path& pipeline) {
  const auto equals = option.find('=');
  const std::string text = option.substr(equals + 1);
  Variant variant{.name = option.substr(0, equals)};
  std::error_code error;
  if (text.find('=') == std::string::npos || fs::exists(text, error)) {
    experiment::take_file(variant, text, pipeline);
    return variant;
  }
  for (const std::string& word : pipeline::parts_of(text, ' ')) {
    if (word.empty()) continue;
    if (word.find('=') == std::string::npos)
      experiment::take_file(variant, word, pipeline);
    else if (const std::string fault = fault_of_set(word); !fault.empty())
      throw UsageError("--variant " + option + ": " + fault);
    else
      variant.sets.push_back(word);
  }
  return variant;
}

double margin_of(const std::string& text) {
  const auto read = pipeline::read_number(text);
  const auto* number = std::get_if<pipeline::Measured>(&read);
  const bool ratio = number && number->unit && number->unit->quantity == Quantity::ratio;
  if (!ratio || !(number->si > 0 && number->si <= 0.5))
    throw UsageError("--margin " + text + ": expected a share of up to 50 %, as in 5%");
  return number->si;
}

SweepBy sweep_by_of(const std::string& word) {
  return word == "paired" ? SweepBy::paired
         : word == "grid" ? SweepBy::grid
                          : SweepBy::one_at_a_time;
}

void add_inputs(Experiment& to, const std::vector<fs::path>& paths) {
  std::vector<fs::path> all;
  for (const Input& input : to.inputs) all.push_back(input.path);
  for (const fs::path& path : paths) {
    all.push_back(path);
    to.inputs.push_back({"", path, {}, "--input " + path.string()});
  }
  const auto names = experiment::names_of(all);
  for (std::size_t k = 0; k < all.size(); ++k)
    if (to.inputs[k].name.empty()) to.inputs[k].name = names[k];
}

/// Also two names that are the same: they would be one folder.
void require_different(const std::vector<Input>& inputs) {
  for (std::size_t k = 0; k < inputs.size(); ++k)
    for (std::size_t n = 0; n < k; ++n) {
      if (fs::weakly_canonical(inputs[k].path) == fs::weakly_canonical(inputs[n].path))
        throw Error(inputs[k].where +
                    ": is given twice, which would make the differences look surer than they are; "
                    "leave one out");
      if (inputs[k].name == inputs[n].name)
        throw Error(inputs[k].where + ": is called '" + inputs[k].name + "' like " +
                    inputs[n].where + "; give one of them another name in the experiment's file");
    }
}

}  // namespace

void ExperimentOptions::add_to(Command command) {
  const auto several = [&](const char* name, auto& to, const char* about) {
    return command.add_option(name, to, about).one_value_each();
  };
  command.add_option("PIPELINE", file, "A pipeline or a preset; or an experiment (YAML)")
      .required();
  several(
      "--variant", variants,
      "NAME=FILE: the pipeline with that preset, or another pipeline by itself (--set does not "
      "reach it); or NAME='PARAMETER=VALUE ...', the pipeline with these settings; may be given "
      "again")
      .check(fault_of_variant);
  several("--sweep", sweeps,
          "PARAMETER=VALUE,VALUE: a variant for each value, a row's in brackets; of several, each "
          "with each");
  command.add_option("--sweep-by", sweep_by, "How the values of several --sweep go together")
      .one_of({"grid", "paired", "one_at_a_time"});
  several("--input", inputs,
          "What the parameter 'input' is set to: a log, or a sequence's folder, of which log.clf, "
          "truth.tum, plan.txt and VARIANT.tum (parameter 'estimate') are used where they are "
          "there; may be given again");
  several(
      "--set", sets,
      "A parameter, a row or a step's parameter, in all runs of the pipeline and its presets; a "
      "'$' in it is written '$$'; may be given again")
      .check(fault_of_set);
  several("--metric", metrics,
          "Numbers to compare, as STEP.NUMBER with * and ?; may be given again. Without: those of "
          "the steps error, map_error, relation_error and match_rmse, of the last stage that they "
          "measure");
  command.add_option("--primary", primary,
                     "The number that decides, as error.fine.ate. Without: the first ATE, or else "
                     "error, or the match RMSE");
  command.add_option("--margin", margin, "Up to which variants count as equivalent; 5% by itself");
  several(
      "--time", timed,
      "Steps whose time and iterations are compared: how their 'use' begins; may be given again. "
      "Without: register. and track.");
  command
      .add_option("--replicates", replicates,
                  "Runs of each variant on each input, of which all but the first are disturbed "
                  "alike: frames left out, segments cut elsewhere, other seeds")
      .range(1, 1000);
  command.add_option("--replicate-seed", seed, "Seed of these disturbances; 0 by itself")
      .range(0, std::numeric_limits<int>::max());
}

bool ExperimentOptions::of_file() const {
  constexpr std::uint64_t largest = 1 << 20;
  try {
    return pipeline::is_experiment(io::FileBytes(file, largest, "pipeline").view());
  } catch (const Error&) {
    return false;  // told by who reads it as a pipeline
  }
}

Experiment ExperimentOptions::asked() const {
  Experiment made;
  if (of_file()) {
    made = experiment::read_experiment(file);
  } else {
    made.name = file.stem().string();
    made.pipeline = file;
  }
  for (const std::string& set : sets)
    if (set.starts_with("input="))
      throw UsageError("--set input=...: --input sets it; leave one of them out");
  made.sets = sets;
  for (const std::string& variant : variants)
    made.variants.push_back(variant_of(variant, made.pipeline));
  for (const std::string& sweep : sweeps)
    made.axes.push_back(usage([&] { return experiment::axis_of(sweep); }));
  if (!sweep_by.empty()) made.sweep_by = sweep_by_of(sweep_by);
  add_inputs(made, inputs);
  if (made.inputs.empty())
    throw UsageError("--input is missing: give the log or the folder to run on");
  require_different(made.inputs);
  made.metrics.insert(made.metrics.end(), metrics.begin(), metrics.end());
  if (!timed.empty()) made.timed = timed, made.timed_where = "--time";
  if (made.timed.empty()) made.timed = ComparedFigures{}.timed;
  if (!primary.empty()) made.primary = primary;
  if (!margin.empty()) made.margin = margin_of(margin);
  if (replicates > 0) made.replicates.count = replicates;
  if (made.replicates.count > 1 && made.replicates.disturb_nothing()) made.replicates.disturb_all();
  if (seed >= 0) made.replicates.seed = static_cast<std::uint64_t>(seed);
  return made;
}

}  // namespace plumb::command
