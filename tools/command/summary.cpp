#include "summary.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "plumb/data/counted.hpp"
#include "plumb/slam/report/made_metrics.hpp"
#include "plumb/slam/report/stages.hpp"
#include "plumb/slam/report/weakness.hpp"

namespace plumb::command {
namespace {

std::string rounded(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(std::abs(value) >= 100 ? 1 : 3) << value;
  return text.str();
}

/// Numbers called "STAGE" or "STAGE.NAME" of all measures as one table: a row a stage, a column a
/// measure.
void print_numbers(std::ostream& out, const Plan& plan, const RunResult& result) {
  std::vector<std::string> columns, rows;
  std::map<std::pair<std::string, std::string>, std::string> cells;
  const auto note = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const MadeMetrics& made : metrics_of(result)) {
    const auto step = std::find_if(plan.steps.begin(), plan.steps.end(),
                                   [&](const PlannedStep& s) { return s.path == made.path; });
    const auto stages = stages_of(*step);
    if (stages.size() < 2) continue;  // a loop's own measure
    for (const std::string& stage : stages)
      for (const Number& number : made.metrics->numbers) {
        if (!is_of_stage(number.name, stage)) continue;
        std::string column = made.path + number.name.substr(stage.size());
        if (!number.unit.empty()) column += " [" + number.unit + "]";
        note(rows, stage);
        note(columns, column);
        cells[{stage, column}] = rounded(number.value);
      }
  }
  if (rows.empty()) return;
  std::size_t first = 0;
  for (const auto& row : rows) first = std::max(first, row.size());
  out << "\n" << std::string(first, ' ');
  for (const auto& column : columns) out << "  " << column;
  out << "\n";
  for (const auto& row : rows) {
    out << std::left << std::setw(static_cast<int>(first)) << row;
    for (const auto& column : columns) {
      const auto at = cells.find({row, column});
      out << "  " << std::right << std::setw(static_cast<int>(column.size()))
          << (at == cells.end() ? "-" : at->second);
    }
    out << "\n";
  }
}

void print_times(std::ostream& out, const RunResult& result) {
  out << "\nCPU seconds of each step, most memory [MiB] that the run held meanwhile (items made, "
         "items remembered)\n";
  for (const StepTime& time : result.times)
    out << "  " << std::left << std::setw(28) << time.path << std::right << std::fixed
        << std::setprecision(2) << std::setw(9) << time.cpu_seconds << std::setw(8)
        << (time.peak_bytes + (1 << 19)) / (1 << 20) << "  (" << time.items << ", "
        << time.remembered << ")\n";
}

}  // namespace

void print_weak(std::ostream& out, const RunResult& result, bool warnings) {
  for (const std::string& sentence : weaknesses(result, warnings))
    out << "weak: " << sentence << "\n";
}

void print_summary(std::ostream& out, const Plan& plan, const RunResult& result,
                   const std::filesystem::path& folder, bool times) {
  print_numbers(out, plan, result);
  out << "\n";
  for (const LoopEnd& loop : result.loops)
    out << loop.path << ": " << counted(loop.passes, "passes") << ", ended because " << loop.why
        << "\n";
  for (const StepCount& count : result.counts) out << "counted: " << count.text() << "\n";
  print_weak(out, result, true);
  if (times) print_times(out, result);
  out << plan.name << ": " << std::fixed << std::setprecision(1) << result.seconds << " s, "
      << std::setprecision(2) << static_cast<double>(result.peak_bytes) / (1 << 30)
      << " GiB at most\n";
  out << "in " << folder.string() << ":";
  for (const MadeDocument& made : result.documents) out << " " << made.document->name;
  out << " run.lock.yaml\n";
}

}  // namespace plumb::command
