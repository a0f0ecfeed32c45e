#include "plumb/pipeline/print/table.hpp"

#include <algorithm>

namespace plumb {
namespace {

std::string aligned(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string heading(const PlannedRepeat& repeat) {
  std::string text = repeat.path + ": ";
  if (repeat.conditions.empty())
    return text + std::to_string(repeat.at_most) + (repeat.at_most == 1 ? " pass" : " passes");
  text +=
      std::to_string(repeat.at_least) + " to " + std::to_string(repeat.at_most) + " passes, until ";
  for (std::size_t k = 0; k < repeat.conditions.size(); ++k)
    text += (k == 0 ? "" : repeat.all ? " and " : " or ") + repeat.conditions[k].text;
  return text;
}

}  // namespace

std::string passes_table(const Plan& plan) {
  std::string text;
  for (const PlannedRepeat& repeat : plan.repeats) {
    std::vector<std::vector<std::string>> lines(1);
    lines[0].emplace_back("pass");
    for (const PlannedRow& row : repeat.rows) lines[0].push_back(row.name);
    const int shown = std::min(repeat.passes, repeat.at_most);
    for (int pass = 0; pass < shown + (repeat.at_most > shown); ++pass) {
      const bool rest = pass == shown;
      std::string name = std::to_string(pass + 1);
      if (rest && repeat.at_most > pass + 1) name += "-" + std::to_string(repeat.at_most);
      lines.push_back({name});
      for (std::size_t k = 0; k < repeat.rows.size(); ++k) {
        ParameterDescription as;
        as.kind = repeat.rows[k].kind;
        as.quantity = repeat.rows[k].quantity;
        const bool unused = repeat.rows[k].values.empty();  // an overlay left it so
        lines.back().push_back(unused ? "-" : written(as, repeat.value(static_cast<int>(k), pass)));
      }
    }
    text += heading(repeat) + "\n";
    for (const auto& line : lines) {
      for (std::size_t c = 0; c < line.size(); ++c) {
        std::size_t width = 0;
        for (const auto& other : lines) width = std::max(width, other[c].size());
        text += "  " + aligned(line[c], width);
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace plumb
