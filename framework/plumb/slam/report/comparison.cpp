#include "plumb/slam/report/comparison.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "plumb/data/error.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/slam/report/made_metrics.hpp"
#include "plumb/slam/report/stages.hpp"

namespace plumb {
namespace {

const PlannedStep& step_at(const Plan& plan, const std::string& path) {
  return *std::find_if(plan.steps.begin(), plan.steps.end(),
                       [&](const PlannedStep& s) { return s.path == path; });
}

bool is_chosen(const PlannedStep& step, const std::string& number,
               const std::vector<std::string>& globs) {
  const std::string name = step.path + "." + number;
  if (!globs.empty())
    return std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
      return fnmatch(glob.c_str(), name.c_str(), 0) == 0;
    });
  if (step.path != "error" && step.path != "map_error" && step.path != "relation_error")
    return false;
  const auto stages = stages_of(step);
  return stages.empty() || is_of_stage(number, stages.back());
}

void require_a_match(const std::string& glob, const RunResult& result) {
  std::vector<std::string> names;
  for (const MadeMetrics& made : metrics_of(result))
    for (const Number& number : made.metrics->numbers) {
      names.push_back(made.path + "." + number.name);
      if (fnmatch(glob.c_str(), names.back().c_str(), 0) == 0) return;
    }
  std::string near = pipeline::nearest(glob, names);
  if (near.empty() && !names.empty()) near = names.front();
  throw Error("no number is called '" + glob + "'" +
              (near.empty() ? ": no step gave any" : "; there is, say, '" + near + "'"));
}

}  // namespace

std::vector<Number> figures_of(const Plan& plan, const RunResult& result,
                               const ComparedFigures& chosen, bool must_match) {
  if (must_match)
    for (const std::string& glob : chosen.metrics) require_a_match(glob, result);
  std::vector<Number> figures;
  for (const MadeMetrics& made : metrics_of(result)) {
    const PlannedStep& step = step_at(plan, made.path);
    for (const Number& number : made.metrics->numbers)
      if (std::isfinite(number.value) && is_chosen(step, number.name, chosen.metrics))
        figures.push_back({made.path + "." + number.name, number.value, number.unit});
  }
  const auto is_timed = [&](const std::string& path) {
    const std::string& name = step_at(plan, path).description->name;
    return std::ranges::any_of(chosen.timed,
                               [&](const auto& first) { return name.starts_with(first); });
  };
  std::string what = "matching";
  if (chosen.timed != ComparedFigures{}.timed) {
    what.clear();
    for (const std::string& first : chosen.timed) what += (what.empty() ? "" : " ") + first + "*";
  }
  double seconds = 0, all_seconds = 0, iterations = 0;
  bool any_timed = false, any_iterations = false;
  for (const StepTime& time : result.times) {
    all_seconds += time.cpu_seconds;
    if (is_timed(time.path)) seconds += time.cpu_seconds, any_timed = true;
  }
  for (const StepCount& count : result.counts)
    if (count.what == "iterations" && is_timed(count.path))
      iterations += static_cast<double>(count.n), any_iterations = true;
  if (any_timed) figures.push_back({what + " time", seconds, "CPU s"});
  if (any_iterations) figures.push_back({what + " iterations", iterations, ""});
  figures.push_back({"time", all_seconds, "CPU s"});
  return figures;
}

double ComparedNumber::mean(std::size_t variant) const {
  const auto& v = values[variant];
  if (v.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

Less ComparedNumber::less_than(std::size_t variant) const {
  const double other = mean(variant);
  if (other == 0 || std::isnan(other)) return {std::numeric_limits<double>::quiet_NaN(), {}};
  const double n = static_cast<double>(inputs.size());
  const double difference = other - mean(0);
  Less less{100 * difference / other, {}};
  if (inputs.size() < 2) return less;
  double squares = 0;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const double off = values[variant][k] - values[0][k] - difference;
    squares += off * off;
  }
  less.interval =
      100 * student_t(inputs.size() - 1) * std::sqrt(squares / (n - 1) / n) / std::abs(other);
  return less;
}

Comparison compare(std::vector<std::string> variants, std::vector<std::string> inputs,
                   const std::vector<std::vector<std::vector<Number>>>& figures) {
  std::vector<Number> rows;
  std::map<std::string, std::vector<std::vector<std::optional<double>>>>
      cells;  // by name, then variant, then input
  for (std::size_t v = 0; v < variants.size(); ++v)
    for (std::size_t k = 0; k < inputs.size(); ++k)
      for (const Number& number : figures[v][k]) {
        auto& cell = cells[number.name];
        if (cell.empty()) {
          rows.push_back(number);
          cell.assign(variants.size(), std::vector<std::optional<double>>(inputs.size()));
        }
        cell[v][k] = number.value;
      }
  Comparison comparison{std::move(variants), std::move(inputs), {}};
  for (const Number& row : rows) {
    const auto& cell = cells[row.name];
    ComparedNumber number{
        row.name, row.unit, {}, std::vector<std::vector<double>>(comparison.variants.size())};
    // Variants that never give it do not keep the others from being compared.
    std::vector<std::size_t> giving;
    for (std::size_t v = 0; v < cell.size(); ++v)
      if (std::ranges::any_of(cell[v], [](const auto& value) { return value.has_value(); }))
        giving.push_back(v);
    if (giving.size() < 2 || giving.front() != 0) continue;
    for (std::size_t k = 0; k < comparison.inputs.size(); ++k) {
      if (!std::ranges::all_of(giving, [&](std::size_t v) { return cell[v][k].has_value(); }))
        continue;
      number.inputs.push_back(k);
      for (const std::size_t v : giving) number.values[v].push_back(*cell[v][k]);
    }
    if (!number.inputs.empty()) comparison.numbers.push_back(std::move(number));
  }
  return comparison;
}

double student_t(std::size_t freedom) {
  static constexpr double few[] = {12.7062, 4.3027, 3.1824, 2.7764, 2.5706,
                                   2.4469,  2.3646, 2.3060, 2.2622, 2.2281};
  if (freedom <= std::size(few)) return few[freedom - 1];
  // Fisher's expansion in 1/freedom (Abramowitz and Stegun 26.7.5).
  const double z = 1.959964, v = static_cast<double>(freedom);
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * v) + (5 * z5 + 16 * z3 + 3 * z) / (96 * v * v) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * v * v * v);
}

}  // namespace plumb
