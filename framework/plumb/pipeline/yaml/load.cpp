#include "plumb/pipeline/yaml/load.hpp"

#include <algorithm>

#include "plumb/pipeline/yaml/finder.hpp"

namespace plumb::pipeline {
namespace {

const Node* map_under(const Node& overlay, const char* key, Diagnostics& diagnostics) {
  const Node* node = overlay.at(key);
  if (!node || node->is_map()) return node;
  diagnostics.add(node->origin,
                  "'" + std::string(key) + "' takes a map, found " + node->shown() + ".");
  return nullptr;
}

void apply_remove(Node& pipeline, const Node& overlay, Renamer& names, Diagnostics& diagnostics) {
  const Node* paths = overlay.at("remove");
  if (!paths) return;
  if (!paths->is_list())
    return diagnostics.add(paths->origin, "'remove' takes a list of steps and parameters, found " +
                                              paths->shown() + ".");
  for (const Node& path : paths->items) {
    if (path.is_scalar())
      Finder(pipeline, path.origin, diagnostics)
          .remove(names.path(pipeline, path.text, path.origin));
    else
      diagnostics.add(path.origin,
                      "'remove' takes names of steps and parameters, found " + path.shown() + ".");
  }
}

/// Every key is one of `known`; `also` holds edits for other pipelines.
void check_keys(const Node& overlay, const std::vector<std::string>& known, const char* what,
                Diagnostics& diagnostics) {
  for (const Entry& entry : overlay.entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      diagnostics.add(entry.origin, std::string(what) + " has no key '" + entry.key + "'.",
                      did_you_mean(entry.key, known));
}

/// False for what is no map.
bool check_also_edits(const Node& edits, Diagnostics& diagnostics) {
  if (edits.is_map())
    check_keys(edits, {"name", "about", "remove", "replace", "add", "set"},
               "what stands under a pipeline of 'also'", diagnostics);
  else
    diagnostics.add(edits.origin,
                    "'also' takes a map of edits for each pipeline, found " + edits.shown() + ".",
                    "As in also: {../plumb.yaml: {set: {noise: 5 cm}}}.");
  return edits.is_map();
}

void check_also(const Node& overlay, Diagnostics& diagnostics) {
  if (const Node* also = map_under(overlay, "also", diagnostics))
    for (const Entry& entry : also->entries) check_also_edits(entry.value, diagnostics);
}

void apply_replace(Node& pipeline, const Node& steps, Renamer& names, Diagnostics& diagnostics) {
  for (const Entry& entry : steps.entries) {
    const std::string path = names.path(pipeline, entry.key, entry.origin);
    if (Node* scope = Finder(pipeline, entry.origin, diagnostics).scope(path, false))
      scope->put(path.substr(path.rfind('.') + 1), entry.origin, entry.value);
  }
}

void apply_add(Node& pipeline, const Node& steps, Diagnostics& diagnostics) {
  for (const Entry& entry : steps.entries) {
    Node* scope = Finder(pipeline, entry.origin, diagnostics).scope(entry.key, true);
    const std::string name = entry.key.substr(entry.key.rfind('.') + 1);
    if (scope && scope->find(name))
      diagnostics.add(
          entry.origin,
          "'" + entry.key + "' is there already, at " + scope->find(name)->origin.text() + ".",
          "Use 'replace'.");
    else if (scope)
      scope->put(name, entry.origin, entry.value);
  }
}

void apply_set(Node& pipeline, const Node& values, Renamer& names, Diagnostics& diagnostics) {
  for (const Entry& entry : values.entries) {
    const std::string path = names.path(pipeline, entry.key, entry.origin);
    const Entry* other = path == entry.key ? nullptr : values.find(path);
    if (other)
      refuse_both(entry.origin, entry.key, path, other->origin, diagnostics);
    else
      Finder(pipeline, entry.origin, diagnostics).set(path, entry.value, false);
  }
}

/// What an overlay and the edits under its 'also' have in common.
void apply_edits(Node& pipeline, const Node& overlay, Renamer& names, Diagnostics& diagnostics) {
  for (const char* key : {"plumb", "name", "about"})
    if (const Entry* entry = overlay.find(key)) pipeline.put(key, entry->origin, entry->value);
  apply_remove(pipeline, overlay, names, diagnostics);
  if (const Node* steps = map_under(overlay, "replace", diagnostics))
    apply_replace(pipeline, *steps, names, diagnostics);
  if (const Node* steps = map_under(overlay, "add", diagnostics))
    apply_add(pipeline, *steps, diagnostics);
  if (const Node* values = map_under(overlay, "set", diagnostics))
    apply_set(pipeline, *values, names, diagnostics);
}

}  // namespace

void apply_overlay(Node& pipeline, const Node& overlay, Renamer& names, Diagnostics& diagnostics) {
  check_keys(overlay,
             {"plumb", "name", "about", "extends", "also", "remove", "replace", "add", "set"},
             "an overlay", diagnostics);
  check_also(overlay, diagnostics);
  const Entry* version = overlay.find("plumb");
  if (!version)
    diagnostics.add({overlay.origin.file, 1, 1},
                    "'plumb: 1' is missing: it says which grammar this file follows.");
  apply_edits(pipeline, overlay, names, diagnostics);
}

void apply_also(Node& pipeline, const Node& edits, Renamer& names, Diagnostics& diagnostics) {
  if (check_also_edits(edits, diagnostics)) apply_edits(pipeline, edits, names, diagnostics);
}

void apply_sets(Node& pipeline, const std::vector<std::string>& options, Renamer& names,
                Diagnostics& diagnostics) {
  std::vector<std::string> seen;
  for (const std::string& option : options) {
    const Origin origin{"--set " + option, 0, 0};
    const auto equals = option.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == option.size()) {
      diagnostics.add(origin, "expected NAME=VALUE.", "As in --set input=DIR.");
      continue;
    }
    const std::string path = names.path(pipeline, option.substr(0, equals), origin);
    if (std::find(seen.begin(), seen.end(), path) != seen.end())
      diagnostics.add(origin, "'" + path + "' is set twice on the command line.");
    seen.push_back(path);
    Node value;
    value.kind = Node::Kind::scalar;
    value.origin = origin;
    value.text = option.substr(equals + 1);
    Finder(pipeline, origin, diagnostics).set(path, std::move(value), true);
  }
}

}  // namespace plumb::pipeline
