/// Gives every step, group and repeat its name.
#include <algorithm>

#include "plumb/pipeline/bind/declaring.hpp"
#include "plumb/pipeline/bind/values.hpp"

namespace plumb::pipeline {

bool valid_name(std::string_view name) {
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) return false;
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

bool add_name(std::vector<Scope>& scopes, int scope, const std::string& name, const Symbol& symbol,
              Diagnostics& diagnostics) {
  if (!valid_name(name)) {
    diagnostics.add(symbol.origin,
                    "'" + name + "' is no name: letters, digits and '_', a letter first.");
    return false;
  }
  for (int at = scope; at >= 0; at = scopes[at].parent) {
    const Symbol* known = scopes[at].find(name);
    if (!known) continue;
    diagnostics.add(symbol.origin, "the name '" + name + "' is taken by an outer one.",
                    "That is at " + known->origin.text() + ".");
    return false;
  }
  scopes[scope].names.insert_or_assign(name, symbol);
  return true;
}

namespace {

class Steps {
 public:
  Steps(const Node& tree, const Settings& settings, const Registry& registry, Reading& reading)
      : settings_(settings), registry_(registry), reading_(reading) {
    if (const Node* steps = tree.at("steps")) number(*steps);
    outline_.scopes.emplace_back();
    read(tree.at("steps"), {tree.origin.file, 1, 1}, 0);
  }

  Outline take() { return std::move(outline_); }

 private:
  void read(const Node* steps, const Origin& origin, int scope) {
    const std::string what = scope == 0 ? "the pipeline" : "'" + outline_.scopes[scope].path + "'";
    if (!steps || !steps->is_map() || steps->entries.empty())
      return reading_.fault(steps ? steps->origin : origin, what + " has no steps.",
                            "Write them under 'steps', by name.");
    std::vector<std::pair<Symbol, const Entry*>> inner;
    for (const Entry& entry :
         steps->entries) {  // all names first, so that inner ones cannot shadow later outer ones
      const auto symbol = name(entry, scope);
      if (symbol) inner.emplace_back(*symbol, &entry);
    }
    for (const auto& [symbol, entry] : inner) {
      if (symbol.kind == Symbol::Kind::group) read_group(*entry, symbol.index);
      if (symbol.kind == Symbol::Kind::repeat) read_repeat(*entry, symbol.index);
    }
  }

  /// Numbers what stands under `steps` in the order written, inner steps between outer ones.
  void number(const Node& steps) {
    for (const Entry& entry : steps.entries) {
      sequence_[&entry.value] = static_cast<int>(sequence_.size());
      if (const Node* inner = entry.value.at("steps")) number(*inner);
    }
  }

  std::string path(int scope, const std::string& name) const {
    const std::string& outer = outline_.scopes[scope].path;
    return outer.empty() ? name : outer + "." + name;
  }

  std::optional<Symbol> name(const Entry& entry, int scope) {
    const Node& node = entry.value;
    const bool is_step = node.is_map() && node.at("use");
    const bool is_repeat = node.is_map() && node.at("repeat");
    if (!is_step && !is_repeat && !(node.is_map() && node.at("steps"))) {
      std::string near;
      for (const std::string& key : node.keys())
        if (near.empty()) near = nearest(key, {"use", "steps", "repeat"});
      reading_.fault(entry.origin,
                     "'" + path(scope, entry.key) +
                         "' is neither a step ('use'), nor a group ('steps'), nor a "
                         "repeat ('repeat' and 'steps').",
                     near.empty() ? "" : "Did you mean '" + near + "'?");
      outline_.scopes[scope].names.try_emplace(entry.key, Faulty());
      reading_.uses.dangling = true;
      return std::nullopt;
    }
    Symbol symbol{Symbol::Kind::group, -1, entry.origin};
    if (is_step)
      symbol.kind = Symbol::Kind::step, symbol.index = static_cast<int>(outline_.steps.size());
    else if (is_repeat)
      symbol.kind = Symbol::Kind::repeat, symbol.index = static_cast<int>(outline_.repeats.size());
    else
      symbol.index = static_cast<int>(outline_.scopes.size());
    if (!add_name(outline_.scopes, scope, entry.key, symbol, reading_.diagnostics))
      return std::nullopt;
    if (is_step)
      add_step(entry, scope);
    else if (is_repeat)
      add_repeat(entry, scope);
    else
      outline_.scopes.push_back({path(scope, entry.key), scope, outline_.scopes[scope].repeat});
    return symbol;
  }

  void add_step(const Entry& entry, int scope) {
    const std::vector<std::string> known = {"use", "from", "with", "on_error"};
    DeclaredStep step;
    step.node = &entry.value;
    step.path = path(scope, entry.key);
    step.origin = entry.origin;
    step.scope = scope;
    step.repeat = outline_.scopes[scope].repeat;
    step.sequence = sequence_.at(step.node);
    check_keys(reading_.diagnostics, *step.node, "step '" + step.path + "'", known);
    step.misspelt =
        std::any_of(step.node->entries.begin(), step.node->entries.end(), [&](const Entry& given) {
          return std::find(known.begin(), known.end(), given.key) == known.end();
        });
    reading_.uses.dangling |= step.misspelt;
    step.use = use_of(step.path, *step.node);
    outline_.steps.push_back(std::move(step));
  }

  OrFaulty<Use> use_of(const std::string& path, const Node& node) {
    const Node& use = *node.at("use");
    const StepDescription* description = use.is_scalar() ? registry_.find(use.text) : nullptr;
    if (description) return Use{description, on_error_of(path, *description, node)};
    unknown_step(path, use);
    return Faulty();
  }

  OnError on_error_of(const std::string& path, const StepDescription& description,
                      const Node& node) {
    const Node* on_error = node.at("on_error");
    if (!on_error || (on_error->is_scalar() && on_error->text == "stop")) return OnError::stop;
    const std::string step = "step '" + path + "'";
    const auto may_be_empty = [](const OutputDescription& port) { return port.type->has_empty; };
    if (!on_error->is_scalar() || on_error->text != "drop")
      reading_.fault(on_error->origin,
                     step + ": on_error is stop or drop, not " + on_error->shown() + ".",
                     "stop: the run ends when the step's other items are done. drop: the item's "
                     "values are empty, as of an edge without matches.");
    else if (!description.itemwise() ||
             !std::all_of(description.outputs.begin(), description.outputs.end(), may_be_empty))
      reading_.fault(on_error->origin,
                     step + ": on_error: drop is for steps whose values may be empty (Matches); " +
                         description.name + " does not.",
                     "Leave it out: the run then stops when the step's other items are done.");
    else
      return OnError::drop;
    return OnError::stop;
  }

  void unknown_step(const std::string& step, const Node& use) {
    const auto left_out = registry_.left_out().find(use.text);
    if (use.is_scalar() && left_out != registry_.left_out().end())
      return reading_.fault(use.origin, "step '" + step + "': '" + use.text +
                                            "' is not in this build: " + left_out->second + ".");
    std::vector<std::string> known;
    for (const StepDescription* description : registry_.all()) known.push_back(description->name);
    std::string hint = did_you_mean(use.text, known);
    hint += (hint.empty() ? "" : "  ") +
            std::string("'plumb list' shows what there is, 'plumb doctor' what was refused.");
    reading_.fault(use.origin,
                   "step '" + step + "': no module offers " +
                       (use.is_scalar() ? "'" + use.text + "'" : "this: " + use.shown()) + ".",
                   hint);
  }

  void add_repeat(const Entry& entry, int scope) {
    DeclaredRepeat repeat;
    repeat.node = &entry.value;
    repeat.path = path(scope, entry.key);
    repeat.origin = entry.origin;
    repeat.scope = scope;
    repeat.body = static_cast<int>(outline_.scopes.size());
    repeat.parent = outline_.scopes[scope].repeat;
    repeat.sequence = sequence_.at(repeat.node);
    outline_.scopes.push_back({repeat.path, scope, static_cast<int>(outline_.repeats.size())});
    outline_.repeats.push_back(std::move(repeat));
  }

  void read_group(const Entry& entry, int scope) {
    check_keys(reading_.diagnostics, entry.value, "group '" + outline_.scopes[scope].path + "'",
               {"steps"});
    read(entry.value.at("steps"), entry.origin, scope);
  }

  void read_repeat(const Entry& entry, int index) {
    outline_.repeats[index].passes = passes_of(outline_, index, settings_, reading_);
    read(entry.value.at("steps"), entry.origin, outline_.repeats[index].body);
  }

  const Settings& settings_;
  const Registry& registry_;
  Reading& reading_;
  Outline outline_;
  std::map<const Node*, int> sequence_;
};

}  // namespace

Outline outline_of(const Node& tree, const Settings& settings, const Registry& registry,
                   Reading& reading) {
  return Steps(tree, settings, registry, reading).take();
}

}  // namespace plumb::pipeline
