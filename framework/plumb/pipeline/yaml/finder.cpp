#include "plumb/pipeline/yaml/finder.hpp"

#include <algorithm>

#include "plumb/pipeline/yaml/parts.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace {

const std::vector<std::string> repeat_settings = {"at_least", "at_most", "if_exhausted"};

/// Text of the command line as the list that it writes, if it does.
Node list_of(const Node& value) {
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

}  // namespace

Node* Finder::scope(const std::string& path, bool fresh) {
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

void Finder::remove(const std::string& path) {
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
    if (k + 2 == parts.size() && (repeat || at->at("use")) && values && values->find(parts.back()))
      return values->erase(parts.back());
    if (at->at("use"))
      return diagnostics_.add(
          origin_,
          "'" + path + "' cannot be removed: the step is not given '" + parts.back() + "'.",
          did_you_mean(parts.back(), values ? values->keys() : std::vector<std::string>()));
    steps = at->at("steps");
  }
}

void Finder::set(const std::string& path, Node value, bool cut) {
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

Node* Finder::lost(const std::string& path, const std::vector<std::string>& parts, std::size_t k,
                   const std::vector<std::string>& known) {
  std::string walked;
  for (std::size_t n = 0; n < k; ++n) walked += (n ? "." : "") + parts[n];
  diagnostics_.add(origin_,
                   "'" + path + "': there is no '" + parts[k] + "' in " +
                       (walked.empty() ? "the pipeline" : "'" + walked + "'") + ".",
                   did_you_mean(parts[k], known));
  return nullptr;
}

void Finder::not_settable(const std::string& path) {
  diagnostics_.add(origin_, "'" + path + "' is nothing that can be set.",
                   "Set a parameter of the pipeline (voxel), a row of a repeat (coarse.gate) or "
                   "a parameter of a step "
                   "(coarse.kept.clusters).");
}

void Finder::set_parameter(const std::string& name, Node value) {
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

void Finder::set_row(Node& repeat, const std::string& path, const std::string& name, Node value,
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

void Finder::set_step(Node& step, const std::string& name, Node value) {
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

}  // namespace plumb::pipeline
