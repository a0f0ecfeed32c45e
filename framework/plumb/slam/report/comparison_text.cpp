#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "plumb/data/counted.hpp"
#include "plumb/data/short_number.hpp"
#include "plumb/slam/report/comparison.hpp"

namespace plumb {
namespace {

std::string percent(const Less& less) {
  if (!std::isfinite(less.percent)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.1f %%", less.percent);
  std::string cell = text;
  if (!less.interval) return cell;
  std::snprintf(text, sizeof text, " +- %.1f", *less.interval);
  return cell + text;
}

std::vector<std::string> row_of(const Comparison& comparison, const ComparedNumber& number) {
  std::vector<std::string> row{number.name + (number.unit.empty() ? "" : " [" + number.unit + "]")};
  if (number.inputs.size() < comparison.inputs.size())
    row[0] += " (" + std::to_string(number.inputs.size()) + " of " +
              counted(comparison.inputs.size(), "inputs") + ")";
  for (std::size_t v = 0; v < comparison.variants.size(); ++v)
    row.push_back(number.values[v].empty() ? "-" : short_number(number.mean(v)));
  for (std::size_t v = 1; v < comparison.variants.size(); ++v)
    row.push_back(percent(number.less_than(v)));
  return row;
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  for (const ComparedNumber& number : comparison.numbers) {
    nlohmann::ordered_json json{{"name", number.name}, {"unit", number.unit}};
    for (const std::size_t k : number.inputs) json["inputs"].push_back(comparison.inputs[k]);
    for (std::size_t v = 0; v < comparison.variants.size(); ++v) {
      if (number.values[v].empty()) continue;
      nlohmann::ordered_json of{{"values", number.values[v]}, {"mean", number.mean(v)}};
      if (v > 0) {
        const Less less = number.less_than(v);
        of["less_by"] = less.percent;
        if (less.interval)
          of["less_by_interval"] = {less.percent - *less.interval, less.percent + *less.interval};
      }
      json["variants"][comparison.variants[v]] = std::move(of);
    }
    numbers.push_back(std::move(json));
  }
  return nlohmann::ordered_json{
      {"variants", comparison.variants}, {"inputs", comparison.inputs}, {"numbers", numbers}}
      .dump(-1, ' ', true,
            nlohmann::ordered_json::error_handler_t::replace);  // names may hold any bytes
}

std::string comparison_table(const Comparison& comparison) {
  std::vector<std::vector<std::string>> rows{{""}};
  for (const auto& variant : comparison.variants) rows[0].push_back(variant);
  for (std::size_t v = 1; v < comparison.variants.size(); ++v)
    rows[0].push_back(comparison.variants.size() == 2 ? "less by"
                                                      : "less than " + comparison.variants[v]);
  for (const ComparedNumber& number : comparison.numbers)
    rows.push_back(row_of(comparison, number));

  std::vector<std::size_t> width(rows[0].size());
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  for (const auto& row : rows) {
    text += row[0] + std::string(width[0] - row[0].size(), ' ');
    for (std::size_t c = 1; c < row.size(); ++c)
      text += "  " + std::string(width[c] - row[c].size(), ' ') + row[c];
    text += "\n";
  }
  const std::size_t n = comparison.inputs.size();
  text += "Means over " + counted(n, "inputs") + ". Less by: 100 (1 - " + comparison.variants[0] +
          " / " + (comparison.variants.size() == 2 ? comparison.variants[1] : "the other") + ")";
  return text +
         (n < 2 ? ".\n" : ", +- 95 % confidence of the inputs' differences (Student's t).\n");
}

}  // namespace plumb
