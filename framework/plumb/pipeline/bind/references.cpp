/// What a reference such as `drift.solved.poses` means, seen from a scope.
#include "plumb/pipeline/bind/binding.hpp"
#include "plumb/pipeline/yaml/parts.hpp"

namespace plumb::pipeline {
namespace {

/// The names that are there, sound ones alone.
std::vector<std::string> names_in(const Declared& declared, int scope, bool outwards) {
  std::vector<std::string> names;
  for (; scope >= 0; scope = outwards ? declared.scopes[scope].parent : -1)
    for (const auto& [name, symbol] : declared.scopes[scope].names)
      if (symbol && (outwards || symbol->kind != Symbol::Kind::carry)) names.push_back(name);
  return names;
}

/// The kind of item that the values of an output belong to; null for one of the whole pipeline.
const ItemKind* grain_of(const StepDescription& step, const OutputDescription& output) {
  return output.emission == Emission::one ? step.items : output.type->kind;
}

/// The step or carried value that the first of a reference's words name.
struct Found {
  Symbol symbol;
  int scope = -1;  ///< that the name is in
};

class Lookup {
 public:
  Lookup(const Declared& declared, Reading& reading, const Node& reference)
      : declared_(declared),
        reading_(reading),
        node_(reference),
        parts_(parts_of(reference.text)) {}

  OrFaulty<Found> find(int scope) {
    int at = scope;
    while (at >= 0 && !declared_.scopes[at].find(parts_[0])) at = declared_.scopes[at].parent;
    if (at < 0) {
      if (!leads_to_faulty(scope, parts_[0], true))
        reading_.fault(node_.origin, "nothing here is called '" + parts_[0] + "'.",
                       did_you_mean(parts_[0], names_in(declared_, scope, true)));
      return Faulty();
    }
    Found found{*declared_.scopes[at].find(parts_[0]), at};
    used_ = 1;
    while (found.symbol.kind == Symbol::Kind::group || found.symbol.kind == Symbol::Kind::repeat) {
      const OrFaulty<Found> inner = within(found.symbol);
      if (!inner) return Faulty();
      found = *inner;
    }
    return found;
  }

  OrFaulty<std::vector<Source>> outputs_of(int step) {
    const DeclaredStep& giver = declared_.steps[step];
    if (!giver.use) {
      reading_.uses.steps.insert(step);
      return Faulty();  // told where the step is
    }
    const StepDescription& description = *giver.use->description;
    if (used_ + 1 == parts_.size())
      if (const auto now = reading_.names.output(description, parts_[used_])) {
        parts_[used_] = *now;
        reading_.rename(node_, joined(parts_, "."));
      }
    std::vector<Source> sources;
    std::vector<std::string> known;
    for (std::size_t k = 0; k < description.outputs.size(); ++k) {
      const OutputDescription& output = description.outputs[k];
      known.push_back(output.name);
      if (used_ < parts_.size() && (output.name != parts_[used_] || used_ + 1 < parts_.size()))
        continue;
      Source source;
      source.wire.step = step;
      source.wire.output = static_cast<int>(k);
      source.wire.label = reading_.text_of_now(node_);
      source.wire.origin = node_.origin;
      source.type = output.type;
      source.grain = grain_of(description, output);
      sources.push_back(std::move(source));
    }
    if (!sources.empty()) return sources;
    reading_.uses.steps.insert(step);
    reading_.fault(node_.origin,
                   used_ < parts_.size() ? giver.title() + " has no output '" + parts_[used_] + "'."
                                         : giver.title() + " has no outputs.",
                   used_ < parts_.size() ? did_you_mean(parts_[used_], known) : "");
    return Faulty();
  }

  /// What is carried has no parts; false when one is named (told).
  bool ends_here() {
    if (used_ == parts_.size()) return true;
    reading_.fault(node_.origin,
                   "'" + parts_[0] + "' is a carried value and has no '" + parts_[used_] + "'.");
    return false;
  }

 private:
  /// The next word, in a group or a repeat.
  OrFaulty<Found> within(const Symbol& outer) {
    const bool group = outer.kind == Symbol::Kind::group;
    const int at = group ? outer.index : declared_.repeats[outer.index].body;
    const Scope& scope = declared_.scopes[at];
    const auto known = names_in(declared_, at, false);
    if (used_ == parts_.size()) {
      reading_.uses.dangling = true;
      reading_.fault(node_.origin,
                     "'" + node_.text + "' is a " + (group ? "group" : "repeat") + ", not a step.",
                     "Name one of its steps: " + joined(known) + ".");
      return Faulty();
    }
    const std::string& name = parts_[used_];
    const Symbol* next = scope.find(name);
    if (!next) {
      if (!leads_to_faulty(at, name, false))
        reading_.fault(node_.origin, "there is no step '" + name + "' in '" + scope.path + "'.",
                       did_you_mean(name, known));
      return Faulty();
    }
    if (next->kind == Symbol::Kind::carry) {
      reading_.uses.dangling = true;
      reading_.fault(node_.origin,
                     "'" + name + "' is what '" + scope.path +
                         "' carries from pass to pass, not seen from outside.",
                     "Name the step of the last pass: " + joined(known) + ".");
      return Faulty();
    }
    ++used_;
    return Found{*next, at};
  }

  /// Whether the name that is not found was told of where it stands.
  bool leads_to_faulty(int scope, const std::string& name, bool outwards) {
    reading_.uses.dangling = true;
    for (; scope >= 0; scope = outwards ? declared_.scopes[scope].parent : -1)
      if (declared_.scopes[scope].has_faulty(name)) return true;
    return false;
  }

  const Declared& declared_;
  Reading& reading_;
  const Node& node_;
  std::vector<std::string> parts_;
  std::size_t used_ = 0;  ///< of the parts
};

}  // namespace

References::References(const Declared& declared, Reading& reading)
    : declared_(declared), reading_(reading) {
  for (const DeclaredRepeat& repeat : declared.repeats)
    carries_.emplace_back(repeat.passes.carries.size());
}

OrFaulty<std::vector<Source>> References::sources(int scope, const Node& reference) {
  if (!reference.is_scalar() || reference.text.empty()) {
    reading_.fault(reference.origin,
                   "expected the name of a step, found " + reference.shown() + ".");
    return Faulty();
  }
  Lookup lookup(declared_, reading_, reference);
  const OrFaulty<Found> found = lookup.find(scope);
  if (!found) return Faulty();
  if (found->symbol.kind == Symbol::Kind::step) return lookup.outputs_of(found->symbol.index);
  if (!lookup.ends_here()) return Faulty();
  return carried(reference, declared_.scopes[found->scope].repeat, found->symbol.index);
}

std::string kind_of(const Type& type, const ItemKind* grain) {
  return grain ? type.name + ", one per " + grain->name : type.name;
}

}  // namespace plumb::pipeline
