#include "plumb/pipeline/print/table.hpp"

#include <algorithm>

#include "plumb/data/counted.hpp"

namespace plumb {
namespace {

std::string aligned(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string heading(const PlannedRepeat& repeat) {
  std::string text = repeat.path + ": " + repeat.passes_text();
  if (!repeat.conditions.empty()) text += ", until ";
  for (std::size_t k = 0; k < repeat.conditions.size(); ++k)
    text += (k == 0 ? "" : repeat.all ? " and " : " or ") + repeat.conditions[k].text;
  return text;
}

using Lines = std::vector<std::vector<std::string>>;

/// A column of passes, and one for each row that a step uses.
Lines lines_of(const PlannedRepeat& repeat) {
  const int shown = std::min(repeat.passes, repeat.at_most);
  const bool rest = repeat.at_most > shown;
  Lines lines(1);
  lines[0].emplace_back("pass");
  for (int pass = 0; pass < shown + rest; ++pass) {
    std::string name = std::to_string(pass + 1);
    if (pass == shown && repeat.at_most > pass + 1) name += "-" + std::to_string(repeat.at_most);
    lines.push_back({name});
  }
  for (std::size_t k = 0; k < repeat.rows.size(); ++k) {
    const PlannedRow& row = repeat.rows[k];
    if (row.values.empty()) continue;
    ParameterDescription as;
    as.kind = row.kind;
    as.quantity = row.quantity;
    lines[0].push_back(row.name);
    for (std::size_t pass = 0; pass + 1 < lines.size(); ++pass)
      lines[pass + 1].push_back(
          written(as, repeat.value(static_cast<int>(k), static_cast<int>(pass))));
  }
  return lines;
}

std::string text_of(const Lines& lines) {
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) {
      std::size_t width = 0;
      for (const auto& other : lines) width = std::max(width, other[c].size());
      text += "  " + aligned(line[c], width);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string passes_table(const Plan& plan) {
  std::string text;
  for (const PlannedRepeat& repeat : plan.repeats) {
    text += heading(repeat) + "\n" + text_of(lines_of(repeat));
    for (const PlannedRow& row : repeat.rows)
      if (row.values.empty())
        text += "  (no step uses the row '" + row.name +
                "' any more: a preset or --set gives what it served another value)\n";
  }
  return text;
}

}  // namespace plumb
