/// Gives every step, group and repeat its name, and reads what a repeat says of its passes.
#include <algorithm>

#include "plumb/pipeline/draft.hpp"

namespace plumb::pipeline {
namespace {

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
      draft_.fault(entry.origin, "'" + path(scope, entry.key) +
                                     "' is neither a step ('use'), nor a group ('steps'), nor a "
                                     "repeat ('repeat' and 'steps').");
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
      draft_.scopes.push_back({path(scope, entry.key), scope, repeat, {}});
    return symbol;
  }

  void add_step(const Entry& entry, int scope, int repeat) {
    const Node& node = entry.value;
    PlannedStep planned;
    planned.path = path(scope, entry.key);
    planned.origin = entry.origin;
    check_keys(draft_, node, "step '" + planned.path + "'", {"use", "from", "with"});
    const Node& use = *node.at("use");
    if (use.is_scalar()) planned.description = draft_.registry.find(use.text);
    if (!planned.description)
      unknown_step(planned.path, use);
    else
      planned.inputs.resize(planned.description->inputs.size());
    draft_.plan.steps.push_back(std::move(planned));
    draft_.steps.push_back({&node, scope, repeat, sequence_.at(&node), false});
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
    draft_.scopes.push_back({planned.path, scope, static_cast<int>(draft_.repeats.size()), {}});
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
    const std::string what = "repeat '" + draft_.plan.repeats[index].path + "'";
    check_keys(draft_, entry.value, what, {"repeat", "start", "steps"});
    const Node& repeat = *entry.value.at("repeat");
    if (check_keys(draft_, repeat, what,
                   {"passes", "carry", "until", "at_least", "at_most", "if_exhausted"})) {
      read_rows(repeat, what, index);
      read_carries(repeat, entry.value.at("start"), what, index);
      read_passes(repeat, what, index);
    }
    read(entry.value.at("steps"), entry.origin, draft_.repeats[index].body);
  }

  void read_rows(const Node& repeat, const std::string& what, int index) {
    const Node* passes = repeat.at("passes");
    if (!passes) return;
    if (!passes->is_map())
      return draft_.fault(passes->origin,
                          what + ": 'passes' is a map of rows, found " + passes->shown() + ".");
    PlannedRepeat& planned = draft_.plan.repeats[index];
    std::string longest;
    for (const Entry& entry : passes->entries) {
      DraftRow row;
      if (entry.value.is_list())
        for (const Node& item : entry.value.items) row.values.push_back(&item);
      else
        row.values.push_back(&entry.value);
      const int columns = static_cast<int>(row.values.size());
      const std::string name = what + ": the row '" + entry.key + "'";
      if (!valid_name(entry.key))
        draft_.fault(entry.origin,
                     name + " has no valid name: letters, digits and '_', a letter first.");
      if (columns == 0) draft_.fault(entry.origin, name + " is empty.");
      refuse_shadow(entry, index, name);
      if (columns > 1 && planned.passes > 1 && columns != planned.passes)
        draft_.fault(entry.value.origin,
                     name + " has " + std::to_string(columns) + " values, '" + longest + "' has " +
                         std::to_string(planned.passes) + ".",
                     "Rows are equally long, or one value for all passes.");
      else if (columns > 1)
        planned.passes = columns, longest = entry.key;
      planned.rows.push_back(
          {entry.key, {}, ParameterKind::number, Quantity::none, entry.value.origin});
      draft_.repeats[index].rows.push_back(std::move(row));
    }
  }

  void refuse_shadow(const Entry& row, int index, const std::string& name) {
    const auto setting = draft_.settings.find(row.key);
    if (setting != draft_.settings.end())
      draft_.fault(row.origin, name + " has the name of a parameter of the pipeline.",
                   "That is at " + setting->second.declared.text() + ".");
    for (int outer = draft_.repeats[index].parent; outer >= 0; outer = draft_.repeats[outer].parent)
      for (const PlannedRow& other : draft_.plan.repeats[outer].rows)
        if (other.name == row.key)
          draft_.fault(row.origin, name + " has the name of an outer row.",
                       "That is at " + other.origin.text() + ".");
  }

  void read_carries(const Node& repeat, const Node* start, const std::string& what, int index) {
    const Node* carry = repeat.at("carry");
    if (carry && !carry->is_map())
      return draft_.fault(carry->origin,
                          what + ": 'carry' is a map, found " + carry->shown() + ".");
    if (start && !start->is_map())
      return draft_.fault(start->origin,
                          what + ": 'start' is a map, found " + start->shown() + ".");
    if (start)
      for (const Entry& entry : start->entries)
        if (!carry || !carry->find(entry.key))
          draft_.fault(entry.origin,
                       what + ": 'start' names '" + entry.key + "', which is not carried.",
                       did_you_mean(entry.key, carry ? carry->keys() : std::vector<std::string>()));
    if (!carry) return;
    for (const Entry& entry : carry->entries) {
      const Symbol symbol{Symbol::Kind::carry,
                          static_cast<int>(draft_.repeats[index].carries.size()), entry.origin};
      if (!declare(draft_, draft_.repeats[index].body, entry.key, symbol)) continue;
      DraftCarry drafted;
      drafted.next = &entry.value;
      drafted.start = start ? start->at(entry.key) : nullptr;
      if (!drafted.start)
        draft_.fault(
            entry.origin,
            what + ": '" + entry.key +
                "' is carried, but 'start' does not say what it is before the first pass.");
      PlannedCarry planned;
      planned.name = entry.key;
      planned.start.origin = drafted.start ? drafted.start->origin : entry.origin;
      planned.next.origin = entry.value.origin;
      draft_.plan.repeats[index].carries.push_back(std::move(planned));
      draft_.repeats[index].carries.push_back(drafted);
    }
  }

  std::optional<int> count(const Node& repeat, const char* key, const std::string& what) {
    const Node* node = repeat.at(key);
    if (!node) return std::nullopt;
    ParameterDescription type;
    type.name = key;
    type.kind = ParameterKind::integer;
    type.low = 1;
    type.high = 1000;
    const auto value = value_of(draft_, what + ": '" + key + "'", type, *node, -1, nullptr);
    if (!value || !std::holds_alternative<std::int64_t>(*value)) return std::nullopt;
    return static_cast<int>(std::get<std::int64_t>(*value));
  }

  void read_passes(const Node& repeat, const std::string& what, int index) {
    PlannedRepeat& planned = draft_.plan.repeats[index];
    const Node* until = repeat.at("until");
    for (const char* key : {"at_least", "if_exhausted"})
      if (!until && repeat.at(key))
        draft_.fault(repeat.find(key)->origin,
                     what + ": '" + key + "' means nothing without 'until'.");
    const auto at_least = count(repeat, "at_least", what), at_most = count(repeat, "at_most", what);
    planned.at_most = at_most.value_or(planned.passes);
    planned.at_least = at_least.value_or(std::min(2, planned.at_most));
    if (until && planned.at_least > planned.at_most)
      draft_.fault(repeat.find(at_least ? "at_least" : "at_most")->origin,
                   what + ": at least " + std::to_string(planned.at_least) +
                       " passes, but at most " + std::to_string(planned.at_most) + ".");
    if (at_most && *at_most < planned.passes)
      draft_.fault(repeat.find("at_most")->value.origin,
                   what + ": the rows have " + std::to_string(planned.passes) +
                       " columns, but 'at_most' is " + std::to_string(*at_most) +
                       ": the last are never reached.",
                   "Shorten the rows.");
    if (planned.rows.empty() && !at_most)
      draft_.fault(planned.origin, what + ": nothing says how many passes.",
                   "Write rows under 'passes', or 'at_most'.");
    if (const Node* node = repeat.at("if_exhausted")) {
      ParameterDescription type;
      type.kind = ParameterKind::choice;
      type.choices = {{"warn", ""}, {"fail", ""}, {"accept", ""}};
      const auto value = value_of(draft_, what + ": 'if_exhausted'", type, *node, -1, nullptr);
      const std::string text = value && std::holds_alternative<std::string>(*value)
                                   ? std::get<std::string>(*value)
                                   : "warn";
      planned.if_exhausted = text == "fail"     ? Exhausted::fail
                             : text == "accept" ? Exhausted::accept
                                                : Exhausted::warn;
    }
  }

  Draft& draft_;
  std::map<const Node*, int> sequence_;
};

}  // namespace

void read_steps(Draft& draft) {
  draft.scopes.push_back({});
  Steps(draft).read(draft.tree.at("steps"), {draft.tree.origin.file, 1, 1}, 0);
}

}  // namespace plumb::pipeline
