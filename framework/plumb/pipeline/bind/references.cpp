/// What a reference such as `drift.solved.poses` means, seen from a scope.
#include <algorithm>

#include "plumb/pipeline/bind/draft.hpp"
#include "plumb/pipeline/yaml/parts.hpp"

namespace plumb::pipeline {
namespace {

std::vector<std::string> names_in(const Draft& draft, int scope, bool outwards) {
  std::vector<std::string> names;
  for (; scope >= 0; scope = outwards ? draft.scopes[scope].parent : -1)
    for (const auto& [name, symbol] : draft.scopes[scope].names)
      if (outwards || symbol.kind != Symbol::Kind::carry) names.push_back(name);
  return names;
}

/// The kind of item that the values of an output belong to; null for one of the whole pipeline.
const ItemKind* grain_of(const StepDescription& step, const OutputDescription& output) {
  return output.emission == Emission::one ? step.items : output.type->kind;
}

class Lookup {
 public:
  Lookup(Draft& draft, const Node& reference)
      : draft_(draft), node_(reference), parts_(parts_of(reference.text)) {}

  std::optional<std::vector<Source>> find(int scope) {
    int at = scope;
    while (at >= 0 && !draft_.scopes[at].names.count(parts_[0])) at = draft_.scopes[at].parent;
    if (at < 0) {
      if (broken(scope, parts_[0], true)) return std::nullopt;
      draft_.fault(node_.origin, "nothing here is called '" + parts_[0] + "'.",
                   did_you_mean(parts_[0], names_in(draft_, scope, true)));
      return std::nullopt;
    }
    Symbol symbol = draft_.scopes[at].names.at(parts_[0]);
    std::size_t used = 1;
    while (symbol.kind == Symbol::Kind::group || symbol.kind == Symbol::Kind::repeat) {
      at = symbol.kind == Symbol::Kind::group ? symbol.index : draft_.repeats[symbol.index].body;
      const std::string& path = draft_.scopes[at].path;
      const auto known = names_in(draft_, at, false);
      if (used == parts_.size()) {
        draft_.dangling = true;
        draft_.fault(node_.origin,
                     "'" + node_.text + "' is a " +
                         (symbol.kind == Symbol::Kind::group ? "group" : "repeat") +
                         ", not a step.",
                     "Name one of its steps: " + joined(known) + ".");
        return std::nullopt;
      }
      const auto next = draft_.scopes[at].names.find(parts_[used]);
      if (next == draft_.scopes[at].names.end()) {
        if (broken(at, parts_[used], false)) return std::nullopt;
        draft_.fault(node_.origin, "there is no step '" + parts_[used] + "' in '" + path + "'.",
                     did_you_mean(parts_[used], known));
        return std::nullopt;
      }
      if (next->second.kind == Symbol::Kind::carry) {
        draft_.dangling = true;
        draft_.fault(node_.origin,
                     "'" + parts_[used] + "' is what '" + path +
                         "' carries from pass to pass, not seen from outside.",
                     "Name the step of the last pass: " + joined(known) + ".");
        return std::nullopt;
      }
      symbol = next->second;
      ++used;
    }
    return symbol.kind == Symbol::Kind::carry
               ? carried(draft_.scopes[at].repeat, symbol.index, used)
               : outputs(symbol.index, used);
  }

 private:
  /// Whether the name that is not found was told of where it stands.
  bool broken(int scope, const std::string& name, bool outwards) {
    draft_.dangling = true;
    for (; scope >= 0; scope = outwards ? draft_.scopes[scope].parent : -1)
      if (draft_.scopes[scope].broken.count(name)) return true;
    return false;
  }

  std::optional<std::vector<Source>> outputs(int step, std::size_t used) {
    const StepDescription* description = draft_.plan.steps[step].description;
    if (!description) {
      draft_.steps[step].used = true;
      return std::nullopt;  // told where the step is
    }
    if (used + 1 == parts_.size())
      if (const auto now = draft_.names.output(*description, parts_[used])) {
        parts_[used] = *now;
        rename(draft_, node_, joined(parts_, "."));
      }
    std::vector<Source> sources;
    std::vector<std::string> known;
    for (std::size_t k = 0; k < description->outputs.size(); ++k) {
      const OutputDescription& output = description->outputs[k];
      known.push_back(output.name);
      if (used < parts_.size() && (output.name != parts_[used] || used + 1 < parts_.size()))
        continue;
      Source source;
      source.wire.step = step;
      source.wire.output = static_cast<int>(k);
      source.wire.label = text_of_now(draft_, node_);
      source.wire.origin = node_.origin;
      source.type = output.type;
      source.grain = grain_of(*description, output);
      sources.push_back(std::move(source));
    }
    if (!sources.empty()) return sources;
    draft_.steps[step].used = true;
    draft_.fault(node_.origin,
                 used < parts_.size()
                     ? draft_.title(step) + " has no output '" + parts_[used] + "'."
                     : draft_.title(step) + " has no outputs.",
                 used < parts_.size() ? did_you_mean(parts_[used], known) : "");
    return std::nullopt;
  }

  std::optional<std::vector<Source>> carried(int repeat, int index, std::size_t used) {
    if (used < parts_.size()) {
      draft_.fault(node_.origin,
                   "'" + parts_[0] + "' is a carried value and has no '" + parts_[used] + "'.");
      return std::nullopt;
    }
    find_pairs(repeat, index);
    DraftCarry& carry = draft_.repeats[repeat].carries[index];
    carry.used = true;
    if (carry.pairs.empty()) return std::nullopt;
    std::vector<Source> sources;
    for (const auto& [start, next] : carry.pairs) {
      Source source;
      source.wire.repeat = repeat;
      source.wire.carry = index;
      source.wire.label = node_.text;
      source.wire.origin = node_.origin;
      source.type = start.type;
      sources.push_back(std::move(source));
    }
    return sources;
  }

  /// The types that both `start` and the body's step give.
  void find_pairs(int repeat, int index) {
    DraftCarry& carry = draft_.repeats[repeat].carries[index];
    if (carry.found) return;
    carry.found = true;
    if (!carry.start) return;
    const std::string what = "repeat '" + draft_.plan.repeats[repeat].path + "': '" +
                             draft_.plan.repeats[repeat].carries[index].name + "'";
    const auto starts = sources_of(draft_, draft_.repeats[repeat].scope, *carry.start);
    const auto nexts = sources_of(draft_, draft_.repeats[repeat].body, *carry.next);
    if (!starts || !nexts) return;
    for (const Source& start : *starts)
      if (start.wire.step >= 0 && inside(draft_, draft_.steps[start.wire.step].repeat, repeat))
        return draft_.fault(carry.start->origin,
                            what + " must start with something from before the repeat.");
    for (const Source& next : *nexts)
      if (next.wire.step < 0 || !inside(draft_, draft_.steps[next.wire.step].repeat, repeat))
        return draft_.fault(carry.next->origin,
                            what + " is carried on from a step of the body, and '" +
                                carry.next->text + "' is none.");
    std::string given, got;
    for (const Source& start : *starts)
      given += (given.empty() ? "" : " and ") + kind_of(*start.type, start.grain);
    for (const Source& next : *nexts)
      got += (got.empty() ? "" : " and ") + kind_of(*next.type, next.grain);
    for (const Source& start : *starts)
      for (const Source& next : *nexts)
        if (start.type == next.type && !start.grain && !next.grain)
          carry.pairs.emplace_back(start, next);
    if (carry.pairs.empty())
      draft_.fault(carry.next->origin,
                   what + " starts as " + given + " and is carried on as " + got + ".",
                   "Both must be of one type, and one value of the whole pipeline.");
  }

  Draft& draft_;
  const Node& node_;
  std::vector<std::string> parts_;
};

}  // namespace

std::optional<std::vector<Source>> sources_of(Draft& draft, int scope, const Node& reference) {
  if (!reference.is_scalar() || reference.text.empty()) {
    draft.fault(reference.origin, "expected the name of a step, found " + reference.shown() + ".");
    return std::nullopt;
  }
  return Lookup(draft, reference).find(scope);
}

bool choose(Draft& draft, const Source& source) {
  if (source.wire.step >= 0) {
    draft.steps[source.wire.step].used = true;
    return true;
  }
  const int repeat = source.wire.repeat, index = source.wire.carry;
  DraftCarry& carry = draft.repeats[repeat].carries[index];
  if (carry.chosen == source.type) return true;
  PlannedCarry& planned = draft.plan.repeats[repeat].carries[index];
  const std::string what =
      "'" + planned.name + "', carried by '" + draft.plan.repeats[repeat].path + "',";
  if (carry.chosen) {
    draft.fault(source.wire.origin,
                what + " is " + carry.chosen->name + " elsewhere and would be " +
                    source.type->name + " here.",
                "Name the outputs in 'start' and 'carry'.");
    return false;
  }
  const auto fits = [&](const auto& pair) { return pair.first.type == source.type; };
  if (std::count_if(carry.pairs.begin(), carry.pairs.end(), fits) != 1) {
    draft.fault(source.wire.origin,
                what + " could be several outputs of type " + source.type->name + ".",
                "Name the outputs in 'start' and 'carry'.");
    return false;
  }
  const auto pair = std::find_if(carry.pairs.begin(), carry.pairs.end(), fits);
  carry.chosen = source.type;
  planned.start = pair->first.wire;
  planned.next = pair->second.wire;
  return choose(draft, pair->first) && choose(draft, pair->second);
}

std::string kind_of(const Type& type, const ItemKind* grain) {
  return grain ? type.name + ", one per " + grain->name : type.name;
}

bool inside(const Draft& draft, int repeat, int of) {
  while (repeat != of && repeat >= 0) repeat = draft.repeats[repeat].parent;
  return repeat == of;
}

}  // namespace plumb::pipeline
