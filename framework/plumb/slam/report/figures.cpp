#include "plumb/slam/report/figures.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/slam/report/made_metrics.hpp"
#include "plumb/slam/report/stages.hpp"

namespace plumb {
namespace {

using experiment::Figure, experiment::SegmentSums;

bool matches(const std::string& glob, const std::string& name) {
  return fnmatch(glob.c_str(), name.c_str(), 0) == 0;
}

/// Whether a glob may match a number of a step, as far as what stands before its first wildcard
/// tells.
bool may_match(const std::string& glob, const std::string& path) {
  const std::string first = glob.substr(0, glob.find_first_of("*?[\\")), own = path + ".";
  return first.starts_with(own) || (first.size() < glob.size() && own.starts_with(first));
}

const PlannedStep& step_at(const Plan& plan, const std::string& path) {
  return *std::ranges::find_if(plan.steps, [&](const PlannedStep& s) { return s.path == path; });
}

bool is_chosen(const PlannedStep& step, const std::string& number, const ComparedFigures& chosen) {
  const std::string name = step.path + "." + number;
  if (name == chosen.primary) return true;
  if (!chosen.metrics.empty())
    return std::ranges::any_of(chosen.metrics,
                               [&](const std::string& glob) { return matches(glob, name); });
  static const std::vector<std::string> usual = {"error", "map_error", "relation_error",
                                                 "match_rmse"};
  if (std::ranges::find(usual, step.path) == usual.end()) return false;
  const auto stages = stages_of(step);
  return stages.empty() || is_of_stage(number, stages.back());
}

/// Of a number that is the mean of its edges' residuals, as the match RMSE of the last stage is:
/// their sums by segment. Empty for any other.
SegmentSums sums_of_edges(const Metrics& metrics, const Number& number) {
  SegmentSums sums;
  double sum = 0, count = 0;
  for (const EdgeRecord& edge : metrics.edges) {
    if (edge.status == "no matches") continue;
    sum += edge.residual, ++count;
    for (const std::size_t segment : {edge.i, edge.j}) {
      if (segment >= sums.size()) sums.sum.resize(segment + 1), sums.count.resize(segment + 1);
      sums.sum[segment] += edge.residual;
      ++sums.count[segment];
    }
  }
  const bool is_their_mean =
      count > 0 && std::abs(sum / count - number.value) <= 1e-9 * std::abs(number.value);
  return is_their_mean ? sums : SegmentSums();
}

/// The CPU time of some steps of a run.
struct Spent {
  double seconds = 0;
  bool any = false, from_cache = false;
};

template <class Is>
Spent spent_in(const RunResult& result, const Is& is_one) {
  const bool reused =
      std::ranges::any_of(result.times, [](const StepTime& time) { return time.earlier > 0; });
  Spent spent;
  for (const StepTime& time : result.times) {
    if (!is_one(time.path)) continue;
    spent.any = true;
    spent.seconds += time.cpu_seconds;
    // What passes through a call that was reused is not asked for, and takes no time either.
    spent.from_cache = spent.from_cache || time.earlier > 0 || (reused && time.items == 0);
  }
  return spent;
}

std::string title_of(const std::vector<std::string>& timed) {
  if (timed == ComparedFigures{}.timed) return "matching";
  std::string title;
  for (const std::string& first : timed) title += (title.empty() ? "" : " ") + first + "*";
  return title;
}

void add_times(std::vector<Figure>& figures, const Plan& plan, const RunResult& result,
               const ComparedFigures& chosen) {
  const auto is_timed = [&](const std::string& path) {
    const std::string& name = step_at(plan, path).description->name;
    return std::ranges::any_of(chosen.timed,
                               [&](const auto& first) { return name.starts_with(first); });
  };
  const std::string title = title_of(chosen.timed);
  double iterations = 0;
  bool any_iterations = false;
  for (const StepCount& count : result.counts)
    if (count.what == "iterations" && is_timed(count.path))
      iterations += static_cast<double>(count.n), any_iterations = true;
  const Spent timed = spent_in(result, is_timed),
              all = spent_in(result, [](const std::string&) { return true; });
  if (timed.any)
    figures.push_back({{title + " time", timed.seconds, "CPU s"}, {}, timed.from_cache});
  if (any_iterations) figures.push_back({{title + " iterations", iterations, ""}});
  figures.push_back({{"time", all.seconds, "CPU s"}, {}, all.from_cache});
}

}  // namespace

std::vector<Figure> figures_of(const Plan& plan, const RunResult& result,
                               const ComparedFigures& chosen) {
  std::vector<Figure> figures;
  for (const MadeMetrics& made : metrics_of(result)) {
    const PlannedStep& step = step_at(plan, made.path);
    for (const Number& number : made.metrics->numbers)
      if (std::isfinite(number.value) && is_chosen(step, number.name, chosen))
        figures.push_back({{made.path + "." + number.name, number.value, number.unit},
                           sums_of_edges(*made.metrics, number)});
  }
  add_times(figures, plan, result, chosen);
  return figures;
}

std::string unmatchable(const std::vector<std::string>& globs, const Plan& plan) {
  std::vector<std::string> paths;
  for (const PlannedStep& step : plan.steps) paths.push_back(step.path);
  for (const std::string& glob : globs) {
    if (std::ranges::any_of(paths, [&](const std::string& path) { return may_match(glob, path); }))
      continue;
    std::string near;
    for (auto dot = glob.find('.'); near.empty() && dot != glob.npos; dot = glob.find('.', dot + 1))
      near = pipeline::nearest(glob.substr(0, dot), paths);
    return "no number can be called '" + glob + "': it is no STEP.NUMBER of a step that there is" +
           (near.empty() ? "" : "; there is, say, the step '" + near + "'");
  }
  return "";
}

std::string unmatched(const std::vector<std::string>& globs, const RunResult& result) {
  std::vector<std::string> names;
  for (const MadeMetrics& made : metrics_of(result))
    for (const Number& number : made.metrics->numbers)
      names.push_back(made.path + "." + number.name);
  for (const std::string& glob : globs) {
    if (std::ranges::any_of(names, [&](const std::string& name) { return matches(glob, name); }))
      continue;
    std::string near = pipeline::nearest(glob, names);
    if (near.empty() && !names.empty()) near = names.front();
    return "no number is called '" + glob + "'" +
           (near.empty() ? ": no step gave any" : "; there is, say, '" + near + "'");
  }
  return "";
}

}  // namespace plumb
