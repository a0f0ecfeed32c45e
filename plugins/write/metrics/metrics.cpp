#include "metrics.hpp"

#include <nlohmann/json.hpp>

namespace plumb::write_metrics {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json numbers_of(const Metrics& metrics) {
  Json numbers = Json::object();
  for (const auto& n : metrics.numbers) numbers[n.name] = {{"value", n.value}, {"unit", n.unit}};
  return numbers;
}

/// Items one a line, indented under a key.
template <class Items, class Line>
std::string list_of(const Items& items, const Line& line) {
  if (items.empty()) return "[]";
  std::string text = "[";
  for (std::size_t k = 0; k < items.size(); ++k)
    text += (k ? ",\n        " : "\n        ") + text_of(line(items[k]));
  return text + "\n      ]";
}

}  // namespace

std::string metrics_json(const std::vector<std::pair<std::string, const Metrics*>>& stages) {
  std::string text = "{\n  \"stages\": [";
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const auto& [label, metrics] = stages[k];
    text += k ? ",\n    {" : "\n    {";
    text += "\n      \"stage\": " + text_of(label);
    text += ",\n      \"numbers\": {";
    const Json numbers = numbers_of(*metrics);
    const char* separator = "\n        ";
    for (const auto& [name, number] : numbers.items()) {
      text += separator + text_of(name) + ": " + text_of(number);
      separator = ",\n        ";
    }
    text += numbers.empty() ? "}" : "\n      }";
    text += ",\n      \"notes\": " +
            list_of(metrics->notes, [](const auto& note) { return Json(note); });
    text += ",\n      \"edges\": " + list_of(metrics->edges, [](const EdgeRecord& e) {
              return Json{{"i", e.i},           {"j", e.j},          {"kind", name_of(e.kind)},
                          {"found", e.found},   {"kept", e.kept},    {"residual", e.residual},
                          {"weight", e.weight}, {"status", e.status}};
            });
    text += "\n    }";
  }
  return text + (stages.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

}  // namespace plumb::write_metrics
