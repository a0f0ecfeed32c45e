#include "plumb/pipeline/yaml/renamer.hpp"

#include <algorithm>
#include <tuple>

#include "plumb/pipeline/yaml/parts.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {
namespace {

using Names = FormerNames::Names;

/// The value under a key, or null.
template <class Map>
const typename Map::mapped_type* under(const Map& map, std::string_view key) {
  const auto at = map.find(key);
  return at == map.end() ? nullptr : &at->second;
}

/// Whether a parameter, a row, a step, a group or a repeat of the pipeline has this path.
bool is_there(const Node& pipeline, const std::string& path) {
  const auto parts = parts_of(path);
  const Node* parameters = pipeline.at("parameters");
  if (parts.size() == 1 && parameters && parameters->find(path)) return true;
  const Node* at = &pipeline;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Node* steps = at->at("steps");
    if (const Node* next = steps ? steps->at(parts[k]) : nullptr) {
      at = next;
      continue;
    }
    const Node* repeat = at->at("repeat");
    const Node* rows = repeat ? repeat->at("passes") : nullptr;
    return k + 1 == parts.size() && rows && rows->find(parts[k]);
  }
  return true;
}

/// `path` with what `names` calls otherwise, the whole of it or the longest beginning.
std::string replaced(const Node& pipeline, const std::string& path, const Names& names) {
  for (std::size_t end = path.size();; end = path.rfind('.', end - 1)) {
    if (end == std::string::npos) return path;
    const std::string beginning = path.substr(0, end);
    const std::string* now = under(names, beginning);
    if (now && !is_there(pipeline, beginning) && is_there(pipeline, *now))
      return *now + path.substr(end);
    if (end == 0) return path;
  }
}

}  // namespace

void refuse_both(const Origin& origin, const std::string& was, const std::string& now,
                 const Origin& other, Diagnostics& diagnostics) {
  diagnostics.add(origin, "'" + was + "' is called '" + now + "' now, and both are given.",
                  "'" + now + "' is at " + other.text() + "; leave '" + was + "' out.");
}

template <class Do>
void Renamer::for_each_step(Node& steps, const Do& act) {
  for (Entry& entry : steps.entries) {
    if (entry.value.at("use")) act(entry);
    if (Node* inner = entry.value.at("steps")) for_each_step(*inner, act);
  }
}

void Renamer::read_steps(const std::vector<Node*>& maps) {
  const std::size_t before = noted_.size();
  for (Node* steps : maps) for_each_step(*steps, [&](Entry& step) { rename(step.value); });
  if (noted_.size() == before) return;
  for (Node* steps : maps) for_each_step(*steps, [&](Entry& step) { restore_defaults(step); });
}

void Renamer::read_pipeline(Node& tree) {
  if (const Node* name = tree.at("name")) pipeline_ = name->text;
  if (Node* steps = tree.at("steps")) read_steps({steps});
}

void Renamer::read_overlay(Node& tree) {
  std::vector<Node*> maps;
  const auto add = [&](Node& edits) {
    for (const char* key : {"replace", "add"})
      if (Node* steps = edits.at(key)) maps.push_back(steps);
  };
  add(tree);
  if (Node* also = tree.at("also"))
    for (Entry& entry : also->entries) add(entry.value);
  read_steps(maps);
}

void Renamer::rename(Node& step) {
  Node& use = *step.at("use");
  const std::string* now = under(table_.steps, use.text);
  if (now && !registry_.find(use.text) && registry_.find(*now)) {
    note(use.origin, use.text, *now);
    use.text = *now;
  }
  const StepDescription* description = registry_.find(use.text);
  if (!description) return;
  if (Node* with = step.at("with"))
    rename_keys(*with, under(table_.parameters, use.text),
                [&](const std::string& name) { return description->parameter(name) != nullptr; });
  if (Node* from = step.at("from"))
    rename_keys(*from, under(table_.inputs, use.text),
                [&](const std::string& name) { return description->input(name) != nullptr; });
}

template <class Declares>
void Renamer::rename_keys(Node& map, const Names* names, const Declares& declares) {
  if (!names) return;
  std::vector<std::string> refused;
  for (Entry& entry : map.entries) {
    const std::string* now = under(*names, entry.key);
    if (!now || declares(entry.key) || !declares(*now)) continue;
    if (const Entry* other = map.find(*now)) {
      refuse_both(entry.origin, entry.key, *now, other->origin, diagnostics_);
      refused.push_back(entry.key);
      continue;
    }
    note(entry.origin, entry.key, *now);
    entry.key = *now;
  }
  for (const std::string& key : refused) map.erase(key);
}

void Renamer::restore_defaults(Entry& entry) {
  Node& step = entry.value;
  const StepDescription* description = registry_.find(step.at("use")->text);
  const Names* defaults = description ? under(table_.defaults, description->name) : nullptr;
  if (!defaults) return;
  for (const auto& [name, text] : *defaults) {
    const ParameterDescription* parameter = description->parameter(name);
    Node* with = step.at("with");
    if (!parameter || parameter->required || (with && (!with->is_map() || with->find(name))))
      continue;
    Node value;
    value.kind = Node::Kind::scalar;
    value.origin = entry.origin;
    value.text = text;
    const auto read = read_value(*parameter, value);
    const auto* si = std::get_if<ParameterValue>(&read);
    if (!si || *si == parameter->standard) continue;
    if (!with) {
      const auto use = std::find_if(step.entries.begin(), step.entries.end(),
                                    [](const Entry& e) { return e.key == "use"; });
      Node map;
      map.kind = Node::Kind::map;
      map.origin = entry.origin;
      with = &step.entries.insert(use + 1, {"with", entry.origin, std::move(map)})->value;
    }
    with->put(name, entry.origin, std::move(value));
    noted_.push_back({Renaming::Kind::standard, entry.origin, name, text});
  }
}

std::string Renamer::path(const Node& pipeline, const std::string& written, const Origin& origin) {
  const Names* names = under(table_.pipelines, pipeline_);
  const std::string now =
      parameter_path(pipeline, names ? replaced(pipeline, written, *names) : written);
  if (now != written) note(origin, written, now);
  return now;
}

/// A step's parameter by its name of now.
std::string Renamer::parameter_path(const Node& pipeline, const std::string& path) const {
  const auto parts = parts_of(path);
  const Node* at = &pipeline;
  for (std::size_t k = 0; at && k + 1 < parts.size(); ++k) {
    const Node* steps = at->at("steps");
    at = steps ? steps->at(parts[k]) : nullptr;
  }
  const Node* use = at && parts.size() > 1 ? at->at("use") : nullptr;
  const StepDescription* step = use ? registry_.find(use->text) : nullptr;
  const Names* names = step ? under(table_.parameters, step->name) : nullptr;
  const std::string* now = names ? under(*names, parts.back()) : nullptr;
  if (!now || step->parameter(parts.back()) || !step->parameter(*now)) return path;
  return path.substr(0, path.size() - parts.back().size()) + *now;
}

std::optional<std::string> Renamer::output(const StepDescription& step,
                                           const std::string& name) const {
  const Names* names = under(table_.outputs, step.name);
  const std::string* now = names ? under(*names, name) : nullptr;
  if (!now || step.output(name) || !step.output(*now)) return std::nullopt;
  return *now;
}

std::optional<std::string> Renamer::choice(const StepDescription& step,
                                           const ParameterDescription& parameter,
                                           const std::string& name) const {
  const auto* parameters = under(table_.choices, step.name);
  const Names* names = parameters ? under(*parameters, parameter.name) : nullptr;
  const std::string* now = names ? under(*names, name) : nullptr;
  const auto offered = [&](const std::string& word) {
    return std::any_of(parameter.choices.begin(), parameter.choices.end(),
                       [&](const Choice& choice) { return choice.name == word; });
  };
  if (!now || offered(name) || !(offered(*now) || *now == "none")) return std::nullopt;
  return *now;
}

std::optional<std::string> Renamer::setting(const std::string& name) const {
  const Names* names = under(table_.pipelines, pipeline_);
  const std::string* now = names ? under(*names, name) : nullptr;
  return now ? std::optional(*now) : std::nullopt;
}

void Renamer::note(const Origin& origin, const std::string& was, const std::string& now) {
  for (const Renaming& known : noted_)
    if (known.was == was && known.origin.text() == origin.text()) return;
  noted_.push_back({Renaming::Kind::text, origin, was, now});
}

std::vector<Renaming> Renamer::noted() const {
  std::vector<std::string> files;
  for (const Renaming& renaming : noted_)
    if (std::find(files.begin(), files.end(), renaming.origin.file) == files.end())
      files.push_back(renaming.origin.file);
  const auto place = [&](const Renaming& renaming) {
    return std::tuple(std::find(files.begin(), files.end(), renaming.origin.file),
                      renaming.origin.line, renaming.origin.column);
  };
  auto sorted = noted_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Renaming& a, const Renaming& b) { return place(a) < place(b); });
  return sorted;
}

}  // namespace plumb::pipeline
