#include "compared_runs.hpp"

#include <algorithm>
#include <iostream>

#include "console.hpp"
#include "pipeline_options.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/file_name.hpp"
#include "plumb/engine/preflight.hpp"
#include "plumb/engine/record/input_record.hpp"
#include "plumb/engine/record/quoted.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/slam/experiment/cell_plan.hpp"
#include "plumb/slam/io/trajectory_text.hpp"
#include "plumb/slam/report/figures.hpp"

namespace plumb::command {
namespace fs = std::filesystem;
namespace {

using experiment::Cell, experiment::Experiment;

/// Hands on what one run tells, under its own name.
class UnderTitle final : public Observer {
 public:
  UnderTitle(Observer* to, std::string title) : to_(to), title_(std::move(title)) {}
  void event(const Event& event) override {
    if (!to_) return;
    Event told = event;
    if (told.kind == Event::Kind::run_begins) told.sentence = title_;
    to_->event(told);
  }

 private:
  Observer* to_;
  std::string title_;
};

ComparedFigures figures_asked(const Experiment& experiment) {
  return {experiment.metrics, experiment.timed, experiment.primary};
}

void require_timed(const Experiment& experiment, const Plan& pipeline) {
  if (experiment.timed == ComparedFigures{}.timed) return;
  for (const std::string& first : experiment.timed)
    if (std::ranges::none_of(pipeline.steps, [&](const PlannedStep& step) {
          return step.description->name.starts_with(first);
        }))
      throw Error(
          experiment.timed_where + " " + first + ": no step of " + experiment.pipeline.string() +
          " uses one whose name begins so; give the beginning of a name that stands behind 'use'");
}

/// Before the first run, where it is known by then; exit code and all as after it.
void require_numbers(const Experiment& experiment, const Plan& pipeline) {
  std::vector<std::string> asked = experiment.metrics;
  if (!experiment.primary.empty()) asked.push_back(experiment.primary);
  std::erase_if(asked, [](const std::string& name) {  // made here, of no step
    return name == "sharpness" || name == "time" || name.ends_with(" time") ||
           name.ends_with(" iterations");
  });
  if (const std::string wrong = unmatchable(asked, pipeline); !wrong.empty())
    throw NothingMeasured(experiment.pipeline.string() + ": " + wrong);
}

std::vector<std::string> names_of(const std::vector<experiment::Variant>& variants) {
  std::vector<std::string> names;
  for (const auto& variant : variants) names.push_back(variant.name);
  return names;
}

std::vector<experiment::InputSize> sizes_of(const std::vector<experiment::Input>& inputs) {
  std::vector<experiment::InputSize> sizes;
  for (const auto& input : inputs) {
    const InputRecord record = input_record(fs::absolute(input.path).string(), false);
    sizes.push_back({input.name, record.files, record.bytes});
  }
  return sizes;
}

/// What of the metrics asked for is a number of a step, and not one that is made here.
std::vector<std::string> of_steps(std::vector<std::string> metrics, const Cell& cell) {
  std::erase_if(metrics, [&](const std::string& name) {
    return name == "sharpness" || cell.find(name) != nullptr;
  });
  return metrics;
}

/// Whether sharpness stands in for what a truth would say, or was asked for.
bool wants_sharpness(const Experiment& experiment, const std::vector<RunBeside>& runs) {
  const auto& metrics = experiment.metrics;
  const std::string name = "sharpness";
  if (experiment.primary == name || std::ranges::find(metrics, name) != metrics.end()) return true;
  return metrics.empty() && std::ranges::none_of(runs, [](const RunBeside& run) {
           return run.written && !run.written->truth.empty();
         });
}

}  // namespace

ComparedRuns::ComparedRuns(const Experiment& experiment, const Registry& steps)
    : experiment_(experiment), steps_(steps), variants_(all_variants(experiment, steps)) {
  for (const auto& variant : variants_)
    for (const auto& input : experiment.inputs)
      for (std::size_t r = 0; r < experiment.replicates.count; ++r) {
        runs_.push_back({cell_plan(experiment, variant, input, r, steps)});
        say_warnings(runs_.back().plan);
      }
  measured_ = {names_of(variants_), sizes_of(experiment.inputs), experiment.replicates.count};
  require_timed(experiment, runs_.front().plan);
  std::vector<const Plan*> first;
  for (std::size_t v = 0; v < variants_.size(); ++v) first.push_back(&runs_[index(v, 0, 0)].plan);
  require_disturbable(experiment, variants_, first);
}

void ComparedRuns::preflight_all() const {
  for (std::size_t v = 0; v < variants_.size(); ++v) preflight(runs_[index(v, 0, 0)].plan, steps_);
}

std::vector<fs::path> ComparedRuns::places(const fs::path& output) const {
  std::vector<fs::path> all;
  for (const auto& variant : variants_)
    for (const auto& input : measured_.inputs)
      for (std::size_t r = 0; r < measured_.replicates; ++r) {
        const fs::path place = output / variant.name / input.name;
        all.push_back(measured_.replicates == 1 ? place
                                                : place / ("replicate_" + std::to_string(r + 1)));
      }
  return all;
}

void ComparedRuns::keep_in(const fs::path& output) {
  for (const auto& input : experiment_.inputs)
    if (const std::string fault = fault_of_file_name(input.name); !fault.empty())
      throw Error(input.where + ": " + plumb::in_quotes(input.name) +
                  ", of which compare makes a folder in -o, " + fault);
  const auto all = places(output);
  for (std::size_t k = 0; k < all.size(); ++k)
    runs_[k].folder = std::make_unique<OutputFolder>(all[k]);
}

std::string ComparedRuns::title(std::size_t v, std::size_t k, std::size_t r) const {
  return variants_[v].name + " on " + measured_.inputs[k].name +
         (measured_.replicates > 1 ? ", replicate " + std::to_string(r + 1) : "");
}

void ComparedRuns::make(const RunsOptions& options) {
  require_numbers(experiment_, runs_.front().plan);
  for (std::size_t k = 0; k < measured_.inputs.size(); ++k)
    for (std::size_t r = 0; r < measured_.replicates; ++r) {
      make_beside(k, r, options);
      if (k == 0 && r == 0 && measured_.at(0, 0).failure.empty())
        require_measured(measured_.at(0, 0));
    }
}

/// All variants on one input in one replicate.
void ComparedRuns::make_beside(std::size_t k, std::size_t r, const RunsOptions& options) {
  std::vector<RunBeside> beside(variants_.size());
  for (std::size_t v = 0; v < variants_.size(); ++v) {
    beside[v].cell = &measured_.at(v, k, r);
    make_one(runs_[index(v, k, r)], beside[v], title(v, k, r), options);
    runs_[index(v, k, r)].folder.reset();
  }
  try {
    stamps_left_out_ = std::max(stamps_left_out_, judge_at_same_stamps(beside));
  } catch (const Error& e) {
    std::cerr << "errors are not known by segment: " << e.what() << "\n";
  }
  if (wants_sharpness(experiment_, beside)) add_sharpness(beside);
}

void ComparedRuns::make_one(Run& run, RunBeside& beside, const std::string& name,
                            const RunsOptions& options) {
  Cell& cell = *beside.cell;
  try {
    Console console(true, "");
    UnderTitle events(options.events, name);
    Observers all({&console, &events});
    RunOptions run_options;
    run_options.threads = options.threads;
    run_options.store = options.store, run_options.fresh = options.fresh;
    run_options.store_bound = options.bound;
    const RunRecord record = run.folder ? record_of(run.plan, false) : RunRecord();
    const RunResult result = run_plan(run.plan, steps_, run_options, all);
    if (const std::string unsettled = run.folder ? run.folder->fill(record, result) : "";
        !unsettled.empty()) {
      std::cerr << unsettled << "\n";
      settled_ = false;
    }
    const ComparedFigures asked = figures_asked(experiment_);
    cell.figures = figures_of(run.plan, result, asked);
    beside.written = written_trajectory(run.plan, result);
    cell.seconds = result.seconds;
    for (const StepTime& time : result.times) cell.made += time.items, cell.reused += time.earlier;
    if (&cell == &measured_.at(0, 0)) unmatched_ = unmatched(of_steps(asked.metrics, cell), result);
    if (!options.quiet)
      std::cerr << name << ": " << io::fixed(cell.seconds, 1) << " s"
                << (cell.reused > 0 ? ", " + std::to_string(cell.reused) + " results from the cache"
                                    : "")
                << "\n";
  } catch (const std::exception& e) {
    cell = Cell();
    cell.failure = e.what();
    if (options.fail_fast) throw FailedFast(name + ": " + cell.failure);
    std::cerr << name << ": failed: " << cell.failure << "\n";
  }
}

/// After the first run, so that what was misspelt is told before hours of the others.
void ComparedRuns::require_measured(const Cell& cell) const {
  if (!unmatched_.empty()) throw NothingMeasured(unmatched_);
  const std::string& primary = experiment_.primary;
  if (primary.empty() || cell.find(primary)) return;
  std::vector<std::string> names;
  for (const auto& figure : cell.figures) names.push_back(figure.number.name);
  throw NothingMeasured("the first run gives no number '" + primary + "', which decides; " +
                        pipeline::did_you_mean(primary, names));
}

}  // namespace plumb::command
