/// Outcomes for programs, a line for each number of each run.
#include <algorithm>
#include <charconv>

#include "plumb/slam/experiment/outcome.hpp"

namespace plumb::experiment {
namespace {

/// As RFC 4180 has it: in quotes where it must be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Reads back as the same double.
std::string exact(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string value_of(const std::vector<std::pair<std::string, std::string>>& swept,
                     const std::string& axis) {
  for (const auto& [name, value] : swept)
    if (name == axis) return value;
  return "";
}

}  // namespace

std::string outcome_csv(const Outcome& outcome) {
  const Measured& m = outcome.measured;
  std::vector<std::string> axes;
  for (const auto& swept : outcome.swept)
    for (const auto& [name, value] : swept)
      if (std::ranges::find(axes, name) == axes.end()) axes.push_back(name);
  std::string text = "variant,input,replicate,metric,value,unit,cached,failed";
  for (const std::string& axis : axes) text += "," + field(axis);
  text += "\n";
  for (std::size_t v = 0; v < m.variants.size(); ++v) {
    std::string settings = "";
    for (const std::string& axis : axes)
      settings += "," + field(v < outcome.swept.size() ? value_of(outcome.swept[v], axis) : "");
    for (std::size_t k = 0; k < m.inputs.size(); ++k)
      for (std::size_t r = 0; r < m.replicates; ++r) {
        const Cell& cell = m.at(v, k, r);
        const std::string run =
            field(m.variants[v]) + "," + field(m.inputs[k].name) + "," + std::to_string(r + 1);
        if (!cell.failure.empty()) text += run + ",,,,0,1" + settings + "\n";
        for (const Figure& figure : cell.figures)
          text += run + "," + field(figure.number.name) + "," + exact(figure.number.value) + "," +
                  field(figure.number.unit) + (figure.from_cache ? ",1" : ",0") + ",0" + settings +
                  "\n";
      }
  }
  return text;
}

}  // namespace plumb::experiment
