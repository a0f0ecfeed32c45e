#include "plumb/pipeline/yaml/load.hpp"

#include <algorithm>

#include "plumb/pipeline/yaml/parts.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace {

const std::vector<std::string> repeat_settings = {"at_least", "at_most", "if_exhausted"};

/// Where `path` leads in a tree: through groups and repeats to a step.
class Finder {
 public:
  Finder(Node& pipeline, const Origin& origin, Diagnostics& diagnostics)
      : pipeline_(pipeline), origin_(origin), diagnostics_(diagnostics) {}

  /// The map of steps that holds the last name of `path`, which need not be there if `fresh`; null
  /// with a diagnostic.
  Node* scope(const std::string& path, bool fresh) {
    const auto parts = parts_of(path);
    Node* steps = pipeline_.at("steps");
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!steps || !steps->is_map()) return lost(path, parts, k, {});
      Node* at = steps->at(parts[k]);
      const bool last = k + 1 == parts.size();
      if (last && (at || fresh)) return steps;
      if (!at) return lost(path, parts, k, steps->keys());
      steps = at->at("steps");
    }
    return nullptr;
  }

  /// Takes away a step, a group or a repeat; a parameter of the pipeline, a row of a repeat; or
  /// what a step is given for a parameter, which then has its default.
  void remove(const std::string& path) {
    const auto parts = parts_of(path);
    if (Node* parameters = pipeline_.at("parameters");
        parts.size() == 1 && parameters && parameters->find(path))
      return parameters->erase(path);
    Node* steps = pipeline_.at("steps");
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!steps || !steps->is_map()) return void(lost(path, parts, k, {}));
      Node* at = steps->at(parts[k]);
      if (!at) {
        auto known = steps->keys();
        if (const Node* parameters = pipeline_.at("parameters"); parameters && k == 0)
          for (const std::string& name : parameters->keys()) known.push_back(name);
        return void(lost(path, parts, k, known));
      }
      if (k + 1 == parts.size()) return steps->erase(parts[k]);
      const Node* repeat = at->at("repeat");
      Node* values = repeat ? at->at("repeat")->at("passes") : at->at("with");
      if (k + 2 == parts.size() && (repeat || at->at("use")) && values &&
          values->find(parts.back()))
        return values->erase(parts.back());
      if (at->at("use"))
        return diagnostics_.add(
            origin_,
            "'" + path + "' cannot be removed: the step is not given '" + parts.back() + "'.",
            did_you_mean(parts.back(), values ? values->keys() : std::vector<std::string>()));
      steps = at->at("steps");
    }
  }

  /// Puts a value at a parameter, a row or a step's parameter. Text of the command line is cut at
  /// commas for a row.
  void set(const std::string& path, Node value, bool cut) {
    const auto parts = parts_of(path);
    if (parts.size() == 1) return set_parameter(path, std::move(value));
    Node* steps = pipeline_.at("steps");
    std::string walked;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!steps || !steps->is_map()) return void(lost(path, parts, k, {}));
      Node* at = steps->at(parts[k]);
      if (!at) return void(lost(path, parts, k, steps->keys()));
      walked += (k ? "." : "") + parts[k];
      Node* repeat = at->at("repeat");
      if (at->at("use") || (repeat && k + 2 == parts.size())) {
        if (k + 2 != parts.size()) return not_settable(path);
        return repeat ? set_row(*repeat, walked, parts.back(), std::move(value), cut)
                      : set_step(*at, parts.back(), std::move(value));
      }
      steps = at->at("steps");
    }
    not_settable(path);
  }

 private:
  Node* lost(const std::string& path, const std::vector<std::string>& parts, std::size_t k,
             std::vector<std::string> known) {
    std::string walked;
    for (std::size_t n = 0; n < k; ++n) walked += (n ? "." : "") + parts[n];
    diagnostics_.add(origin_,
                     "'" + path + "': there is no '" + parts[k] + "' in " +
                         (walked.empty() ? "the pipeline" : "'" + walked + "'") + ".",
                     did_you_mean(parts[k], known));
    return nullptr;
  }
  void not_settable(const std::string& path) {
    diagnostics_.add(origin_, "'" + path + "' is nothing that can be set.",
                     "Set a parameter of the pipeline (voxel), a row of a repeat (coarse.gate) or "
                     "a parameter of a step "
                     "(coarse.kept.clusters).");
  }
  void set_parameter(const std::string& name, Node value) {
    Node* parameters = pipeline_.at("parameters");
    Node* at = parameters ? parameters->at(name) : nullptr;
    if (!at || !at->is_map()) {
      diagnostics_.add(
          origin_, "the pipeline has no parameter '" + name + "'.",
          did_you_mean(name, parameters ? parameters->keys() : std::vector<std::string>()));
      return;
    }
    at->put("default", origin_, std::move(value));
  }
  void set_row(Node& repeat, const std::string& path, const std::string& name, Node value,
               bool cut) {
    Node* passes = repeat.at("passes");
    if (passes && passes->at(name)) {
      if (cut) value = list_of(value);
      passes->put(name, origin_, std::move(value));
      return;
    }
    if (std::find(repeat_settings.begin(), repeat_settings.end(), name) != repeat_settings.end()) {
      repeat.put(name, origin_, std::move(value));
      return;
    }
    std::vector<std::string> known = passes ? passes->keys() : std::vector<std::string>();
    known.insert(known.end(), repeat_settings.begin(), repeat_settings.end());
    diagnostics_.add(origin_, "the repeat '" + path + "' has no row '" + name + "'.",
                     did_you_mean(name, known));
  }
  void set_step(Node& step, const std::string& name, Node value) {
    Node* with = step.at("with");
    if (!with || !with->is_map()) {
      Node empty;
      empty.kind = Node::Kind::map;
      empty.origin = origin_;
      step.put("with", origin_, empty);
      with = step.at("with");
    }
    with->put(name, origin_, std::move(value));
  }
  Node list_of(const Node& value) const {
    std::string text = value.text;
    if (text.size() >= 2 && text.front() == '[' && text.back() == ']')
      text = text.substr(1, text.size() - 2);
    else if (text.find(',') == std::string::npos)
      return value;
    Node list;
    list.kind = Node::Kind::list;
    list.origin = value.origin;
    for (std::string part : parts_of(text, ',')) {
      part.erase(0, std::min(part.size(), part.find_first_not_of(' ')));
      part.erase(part.find_last_not_of(' ') + 1);
      Node item = value;
      item.text = part;
      list.items.push_back(std::move(item));
    }
    return list;
  }

  Node& pipeline_;
  Origin origin_;
  Diagnostics& diagnostics_;
};

const Node* map_under(const Node& overlay, const char* key, Diagnostics& diagnostics) {
  const Node* node = overlay.at(key);
  if (!node || node->is_map()) return node;
  diagnostics.add(node->origin,
                  "'" + std::string(key) + "' takes a map, found " + node->shown() + ".");
  return nullptr;
}

void apply_remove(Node& pipeline, const Node& overlay, Diagnostics& diagnostics) {
  const Node* paths = overlay.at("remove");
  if (!paths) return;
  if (!paths->is_list())
    return diagnostics.add(paths->origin, "'remove' takes a list of steps and parameters, found " +
                                              paths->shown() + ".");
  for (const Node& path : paths->items) {
    if (path.is_scalar())
      Finder(pipeline, path.origin, diagnostics).remove(path.text);
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
                    "As in also: {../plumb.yaml: {set: {voxel_size: 0.3 m}}}.");
  return edits.is_map();
}

void check_also(const Node& overlay, Diagnostics& diagnostics) {
  if (const Node* also = map_under(overlay, "also", diagnostics))
    for (const Entry& entry : also->entries) check_also_edits(entry.value, diagnostics);
}

/// What an overlay and the edits under its 'also' have in common.
void apply_edits(Node& pipeline, const Node& overlay, Diagnostics& diagnostics) {
  for (const char* key : {"plumb", "name", "about"})
    if (const Entry* entry = overlay.find(key)) pipeline.put(key, entry->origin, entry->value);

  apply_remove(pipeline, overlay, diagnostics);
  if (const Node* steps = map_under(overlay, "replace", diagnostics))
    for (const Entry& entry : steps->entries)
      if (Node* scope = Finder(pipeline, entry.origin, diagnostics).scope(entry.key, false))
        scope->put(entry.key.substr(entry.key.rfind('.') + 1), entry.origin, entry.value);
  if (const Node* steps = map_under(overlay, "add", diagnostics)) {
    for (const Entry& entry : steps->entries) {
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
  if (const Node* values = map_under(overlay, "set", diagnostics))
    for (const Entry& entry : values->entries)
      Finder(pipeline, entry.origin, diagnostics).set(entry.key, entry.value, false);
}

}  // namespace

void apply_overlay(Node& pipeline, const Node& overlay, Diagnostics& diagnostics) {
  check_keys(overlay,
             {"plumb", "name", "about", "extends", "also", "remove", "replace", "add", "set"},
             "an overlay", diagnostics);
  check_also(overlay, diagnostics);
  const Entry* version = overlay.find("plumb");
  if (!version)
    diagnostics.add({overlay.origin.file, 1, 1},
                    "'plumb: 1' is missing: it says which grammar this file follows.");
  apply_edits(pipeline, overlay, diagnostics);
}

void apply_also(Node& pipeline, const Node& edits, Diagnostics& diagnostics) {
  if (check_also_edits(edits, diagnostics)) apply_edits(pipeline, edits, diagnostics);
}

void apply_set(Node& pipeline, const std::string& option, Diagnostics& diagnostics) {
  const Origin origin{"--set " + option, 0, 0};
  const auto equals = option.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == option.size())
    return diagnostics.add(origin, "expected NAME=VALUE.", "As in --set leaf=0.2m.");
  Node value;
  value.kind = Node::Kind::scalar;
  value.origin = origin;
  value.text = option.substr(equals + 1);
  Finder(pipeline, origin, diagnostics).set(option.substr(0, equals), std::move(value), true);
}

}  // namespace plumb::pipeline
