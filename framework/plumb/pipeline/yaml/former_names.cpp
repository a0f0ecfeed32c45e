#include "plumb/pipeline/yaml/former_names.hpp"

#include <algorithm>

#include "plumb/pipeline/yaml/foreign_file.hpp"
#include "plumb/pipeline/yaml/tree.hpp"

namespace plumb {

namespace pipeline {
extern const char former_names_text[];  // made by CMake
namespace {

void read(const Node& node, std::string& text, Diagnostics& diagnostics) {
  if (!node.is_scalar())
    return diagnostics.add(node.origin, "expected a name, found " + node.shown() + ".");
  text = node.text;
}

template <class Inner>
void read(const Node& node, std::map<std::string, Inner, std::less<>>& map,
          Diagnostics& diagnostics) {
  if (node.kind == Node::Kind::none) return;
  if (!node.is_map())
    return diagnostics.add(node.origin, "expected a map, found " + node.shown() + ".");
  for (const Entry& entry : node.entries) read(entry.value, map[entry.key], diagnostics);
}

}  // namespace
}  // namespace pipeline

FormerNames read_former_names(const std::string& text, const std::string& file) {
  using namespace pipeline;
  FormerNames names;
  if (has_key(text, {})) return names;  // blanks and comments
  Diagnostics diagnostics;
  const auto tree = parse_yaml(text, file, diagnostics);
  if (!tree) diagnostics.raise();
  const auto read_under = [&](const char* key, auto& map) {
    if (const Node* node = tree->at(key)) read(*node, map, diagnostics);
  };
  read_under("steps", names.steps);
  read_under("inputs", names.inputs);
  read_under("outputs", names.outputs);
  read_under("parameters", names.parameters);
  read_under("choices", names.choices);
  read_under("defaults", names.defaults);
  read_under("pipelines", names.pipelines);
  const std::vector<std::string> known = {"steps",   "inputs",   "outputs",  "parameters",
                                          "choices", "defaults", "pipelines"};
  for (const Entry& entry : tree->entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      diagnostics.add(entry.origin, "a table of former names has no key '" + entry.key + "'.",
                      did_you_mean(entry.key, known));
  diagnostics.raise();
  return names;
}

const FormerNames& shipped_former_names() {
  static const FormerNames names =
      read_former_names(pipeline::former_names_text, "plugins/former_names.yaml");
  return names;
}

}  // namespace plumb
