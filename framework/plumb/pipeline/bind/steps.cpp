/// Gives every step, group and repeat its name.
#include <algorithm>

#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {

bool valid_name(std::string_view name) {
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) return false;
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

/// Adds a name to a scope. A name that an outer scope has too is refused: nobody could say which is
/// meant.
bool declare(Draft& draft, int scope, const std::string& name, const Symbol& symbol) {
  if (!valid_name(name)) {
    draft.fault(symbol.origin,
                "'" + name + "' is no name: letters, digits and '_', a letter first.");
    return false;
  }
  for (int at = scope; at >= 0; at = draft.scopes[at].parent) {
    const auto known = draft.scopes[at].names.find(name);
    if (known == draft.scopes[at].names.end()) continue;
    draft.fault(symbol.origin, "the name '" + name + "' is taken by an outer one.",
                "That is at " + known->second.origin.text() + ".");
    return false;
  }
  draft.scopes[scope].names[name] = symbol;
  return true;
}

namespace {

class Steps {
 public:
  explicit Steps(Draft& draft) : draft_(draft) {
    if (const Node* steps = draft.tree.at("steps")) number(*steps);
  }

  void read(const Node* steps, const Origin& origin, int scope) {
    const std::string what = scope == 0 ? "the pipeline" : "'" + draft_.scopes[scope].path + "'";
    if (!steps || !steps->is_map() || steps->entries.empty())
      return draft_.fault(steps ? steps->origin : origin, what + " has no steps.",
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

 private:
  /// Numbers what stands under `steps` in the order written, inner steps between outer ones.
  void number(const Node& steps) {
    for (const Entry& entry : steps.entries) {
      sequence_[&entry.value] = static_cast<int>(sequence_.size());
      if (const Node* inner = entry.value.at("steps")) number(*inner);
    }
  }

  std::string path(int scope, const std::string& name) const {
    const std::string& outer = draft_.scopes[scope].path;
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
      draft_.fault(entry.origin,
                   "'" + path(scope, entry.key) +
                       "' is neither a step ('use'), nor a group ('steps'), nor a "
                       "repeat ('repeat' and 'steps').",
                   near.empty() ? "" : "Did you mean '" + near + "'?");
      draft_.scopes[scope].broken.insert(entry.key);
      draft_.dangling = true;
      return std::nullopt;
    }
    Symbol symbol{Symbol::Kind::group, -1, entry.origin};
    if (is_step)
      symbol.kind = Symbol::Kind::step, symbol.index = static_cast<int>(draft_.steps.size());
    else if (is_repeat)
      symbol.kind = Symbol::Kind::repeat, symbol.index = static_cast<int>(draft_.repeats.size());
    else
      symbol.index = static_cast<int>(draft_.scopes.size());
    if (!declare(draft_, scope, entry.key, symbol)) return std::nullopt;
    const int repeat = draft_.scopes[scope].repeat;
    if (is_step)
      add_step(entry, scope, repeat);
    else if (is_repeat)
      add_repeat(entry, scope, repeat);
    else
      draft_.scopes.push_back({path(scope, entry.key), scope, repeat, {}, {}});
    return symbol;
  }

  void add_step(const Entry& entry, int scope, int repeat) {
    const Node& node = entry.value;
    PlannedStep planned;
    planned.path = path(scope, entry.key);
    planned.origin = entry.origin;
    check_keys(draft_, node, "step '" + planned.path + "'", {"use", "from", "with", "on_error"});
    const Node& use = *node.at("use");
    if (use.is_scalar()) planned.description = draft_.registry.find(use.text);
    if (!planned.description)
      unknown_step(planned.path, use);
    else
      planned.inputs.resize(planned.description->inputs.size()), read_on_error(planned, node);
    draft_.plan.steps.push_back(std::move(planned));
    DraftStep drafted{&node, scope, repeat, sequence_.at(&node)};
    for (const std::string& key : node.keys())
      drafted.misspelt |= key != "use" && key != "from" && key != "with" && key != "on_error";
    draft_.dangling |= drafted.misspelt;
    draft_.steps.push_back(drafted);
  }

  void read_on_error(PlannedStep& planned, const Node& node) {
    const Node* on_error = node.at("on_error");
    if (!on_error) return;
    const std::string step = "step '" + planned.path + "'";
    if (on_error->is_scalar() && on_error->text == "stop") return;
    if (!on_error->is_scalar() || on_error->text != "drop")
      return draft_.fault(
          on_error->origin, step + ": on_error is stop or drop, not " + on_error->shown() + ".",
          "stop: the run ends when the step's other items are done. drop: the item's "
          "values are empty, as of an edge without matches.");
    const auto& outputs = planned.description->outputs;
    if (!planned.description->itemwise() ||
        !std::all_of(outputs.begin(), outputs.end(),
                     [](const auto& port) { return port.type->has_empty; }))
      return draft_.fault(
          on_error->origin,
          step + ": on_error: drop is for steps whose values may be empty (Matches); " +
              planned.description->name + " does not.",
          "Leave it out: the run then stops when the step's other items are done.");
    planned.on_error = OnError::drop;
  }

  void unknown_step(const std::string& step, const Node& use) {
    std::vector<std::string> known;
    for (const StepDescription* description : draft_.registry.all())
      known.push_back(description->name);
    std::string hint = did_you_mean(use.text, known);
    hint += (hint.empty() ? "" : "  ") +
            std::string("'plumb list' shows what there is, 'plumb doctor' what was refused.");
    draft_.fault(use.origin,
                 "step '" + step + "': no module offers " +
                     (use.is_scalar() ? "'" + use.text + "'" : "this: " + use.shown()) + ".",
                 hint);
  }

  void add_repeat(const Entry& entry, int scope, int around) {
    PlannedRepeat planned;
    planned.path = path(scope, entry.key);
    planned.origin = entry.origin;
    const int body = static_cast<int>(draft_.scopes.size());
    draft_.scopes.push_back({planned.path, scope, static_cast<int>(draft_.repeats.size()), {}, {}});
    draft_.plan.repeats.push_back(std::move(planned));
    DraftRepeat repeat;
    repeat.node = &entry.value;
    repeat.scope = scope;
    repeat.body = body;
    repeat.parent = around;
    repeat.sequence = sequence_.at(&entry.value);
    draft_.repeats.push_back(std::move(repeat));
  }

  void read_group(const Entry& entry, int scope) {
    check_keys(draft_, entry.value, "group '" + draft_.scopes[scope].path + "'", {"steps"});
    read(entry.value.at("steps"), entry.origin, scope);
  }

  void read_repeat(const Entry& entry, int index) {
    read_passes(draft_, index);
    read(entry.value.at("steps"), entry.origin, draft_.repeats[index].body);
  }

  Draft& draft_;
  std::map<const Node*, int> sequence_;
};

}  // namespace

void read_steps(Draft& draft) {
  draft.scopes.emplace_back();
  Steps(draft).read(draft.tree.at("steps"), {draft.tree.origin.file, 1, 1}, 0);
}

}  // namespace plumb::pipeline
