/// From the tree to names: the pipeline's header, and the parts of declare() in their order.
#include <filesystem>

#include "plumb/pipeline/bind/declaring.hpp"
#include "plumb/pipeline/bind/values.hpp"

namespace plumb::pipeline {
namespace {

void check_header(const Node& tree, Diagnostics& diagnostics) {
  check_keys(diagnostics, tree, "the pipeline", {"plumb", "name", "about", "parameters", "steps"});
  const Node* version = tree.at("plumb");
  if (!version)
    diagnostics.add({tree.origin.file, 1, 1},
                    "'plumb: 1' is missing: it says which grammar this file follows.");
  else if (!version->is_scalar() || version->text != "1")
    diagnostics.add(version->origin, "this is Plumb's grammar 1, found " + version->shown() + ".",
                    "Write 'plumb: 1'.");
}

std::string text_under(const Node& tree, const char* key, Diagnostics& diagnostics) {
  const Node* node = tree.at(key);
  if (!node) return "";
  if (!node->is_scalar())
    diagnostics.add(node->origin,
                    "'" + std::string(key) + "' is text, found " + node->shown() + ".");
  return node->text;
}

}  // namespace

Declared declare(std::shared_ptr<const Loaded> loaded, bool open, const Registry& registry,
                 Renamer& names, Diagnostics& diagnostics) {
  const Node& tree = loaded->tree;
  Reading reading{names, diagnostics};
  Declared declared;
  check_header(tree, diagnostics);
  declared.name = text_under(tree, "name", diagnostics);
  declared.about = text_under(tree, "about", diagnostics);
  if (declared.name.empty())
    declared.name = std::filesystem::path(loaded->files.front()).stem().string();
  declared.settings = settings_of(tree, open, diagnostics);
  Outline outline = outline_of(tree, declared.settings, registry, reading);
  declared.scopes = std::move(outline.scopes);
  declared.steps = std::move(outline.steps);
  declared.repeats = std::move(outline.repeats);
  declared.uses = std::move(reading.uses);
  declared.now = std::move(reading.now);
  declared.loaded = std::move(loaded);
  return declared;
}

const Symbol* Scope::find(std::string_view name) const {
  const auto at = names.find(name);
  return at != names.end() && at->second ? &*at->second : nullptr;
}

bool Scope::has_faulty(std::string_view name) const {
  const auto at = names.find(name);
  return at != names.end() && !at->second;
}

std::string DeclaredStep::title() const {
  return "step '" + path + "'" + (use ? " (" + use->description->name + ")" : "");
}

std::optional<std::pair<int, int>> find_row(const Declared& declared, const std::string& name,
                                            int repeat) {
  for (; repeat >= 0; repeat = declared.repeats[repeat].parent) {
    const auto& rows = declared.repeats[repeat].passes.rows;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k].name == name) return std::pair(repeat, static_cast<int>(k));
  }
  return std::nullopt;
}

bool inside(const Declared& declared, int repeat, int of) {
  while (repeat != of && repeat >= 0) repeat = declared.repeats[repeat].parent;
  return repeat == of;
}

}  // namespace plumb::pipeline
