/// Binds the ports of every step: by name, or the one port that fits.
#include <algorithm>

#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {
namespace {

/// Which grains an input takes: item kinds, or null for one value of the pipeline. None: any kind.
std::vector<const ItemKind*> grains_for(const StepDescription& step,
                                        const InputDescription& input) {
  switch (input.access) {
    case Access::ends:
      return {step.items ? find_kind(step.items->ends) : nullptr};
    case Access::each:
      if (!step.items) return {};
      return {find_kind(step.items->parts)};
    case Access::several:
    case Access::part:
      return {nullptr};
    case Access::item:
      break;
  }
  if (!step.items || !input.type->kind) return {nullptr};
  return {step.items, nullptr};
}

bool fits(const StepDescription& step, const InputDescription& input, const Source& source) {
  if (source.type != input.type) return false;
  const auto grains = grains_for(step, input);
  if (grains.empty()) return source.grain != nullptr;
  return std::find(grains.begin(), grains.end(), source.grain) != grains.end();
}

/// "Features, one per segment": what a port wants.
std::string wanted(const StepDescription& step, const InputDescription& input) {
  const auto grains = grains_for(step, input);
  const bool own =
      grains.empty() || std::find(grains.begin(), grains.end(), input.type->kind) != grains.end();
  std::string text = kind_of(*input.type, own ? input.type->kind : grains.front());
  if (input.access == Access::several) text += ", any number of them";
  return text;
}

class Binder {
 public:
  Binder(Draft& draft, int step)
      : draft_(draft),
        step_(step),
        scope_(draft.steps[step].scope),
        planned_(draft.plan.steps[step]),
        title_(draft.title(step)) {}

  void bind() {
    const Node* from = draft_.steps[step_].node->at("from");
    if (!planned_.description) {
      if (from) mark(*from);
      return;
    }
    if (from && from->is_map())
      bind_ports(*from);
    else if (from && from->is_list())
      bind_list(*from);
    else if (from)
      bind_one(*from);
    for (std::size_t k = 0; k < planned_.inputs.size(); ++k) {
      const InputDescription& input = planned_.description->inputs[k];
      if (!planned_.inputs[k].empty() || input.optional || faulty_ || draft_.steps[step_].misspelt)
        continue;
      draft_.fault(planned_.origin,
                   title_ + ": its input '" + input.name + "' is not wired, it wants " +
                       wanted(step(), input) + ".",
                   candidates(input));
    }
  }

 private:
  const StepDescription& step() const { return *planned_.description; }

  /// Of a step that no module offers: what it refers to counts as used.
  void mark(const Node& from) {
    for (const Node& item : from.items) mark(item);
    for (const Entry& entry : from.entries) mark(entry.value);
    if (!from.is_scalar()) return;
    const auto sources = sources_of(draft_, scope_, from);
    if (sources && sources->size() == 1)
      choose(draft_, sources->front());
    else if (sources)
      for (const Source& source : *sources)
        if (source.wire.step >= 0) draft_.steps[source.wire.step].used = true;
  }

  std::vector<std::string> ports() const {
    std::vector<std::string> names;
    for (const InputDescription& input : planned_.description->inputs) names.push_back(input.name);
    return names;
  }

  /// Steps in sight that would fit a port.
  std::string candidates(const InputDescription& input) const {
    std::vector<std::string> names;
    for (int scope = scope_; scope >= 0; scope = draft_.scopes[scope].parent) {
      for (const auto& [name, symbol] : draft_.scopes[scope].names) {
        if (symbol.kind != Symbol::Kind::step || symbol.index == step_) continue;
        const StepDescription* other = draft_.plan.steps[symbol.index].description;
        if (other && std::any_of(other->outputs.begin(), other->outputs.end(),
                                 [&](const auto& o) { return o.type == input.type; }))
          names.push_back(name);
      }
    }
    return names.empty() ? ""
                         : "Of type " + std::string(input.type->name) + ": " + joined(names) + ".";
  }

  void fault(const Node& at, const std::string& sentence, const std::string& hint = "") {
    faulty_ = true;
    draft_.fault(at.origin, title_ + ": " + sentence, hint);
  }

  void bind_one(const Node& from) {
    const auto sources = sources_of(draft_, scope_, from);
    if (!sources) return void(faulty_ = true);
    std::vector<std::pair<std::size_t, const Source*>> fitting;
    const auto& inputs = planned_.description->inputs;
    for (std::size_t k = 0; k < inputs.size(); ++k)
      for (const Source& source : *sources)
        if (fits(step(), inputs[k], source)) fitting.emplace_back(k, &source);
    // `from: STEP` feeds a step's own input, not the scale of its lengths (Declaration::scale),
    // which is named where it is meant.
    std::erase_if(fitting, [&](const auto& fit) {
      return inputs[fit.first].optional && inputs[fit.first].name == "scale";
    });
    std::string gives;
    for (const Source& source : *sources) {
      gives += (gives.empty() ? "" : " and ") + kind_of(*source.type, source.grain);
      if (fitting.size() != 1 && source.wire.step >= 0) draft_.steps[source.wire.step].used = true;
    }
    if (fitting.size() == 1) {
      wire(fitting[0].first, *fitting[0].second);
    } else if (fitting.empty()) {
      std::vector<std::string> want;
      want.reserve(inputs.size());
      for (const InputDescription& input : inputs)
        want.push_back("'" + input.name + "' [" + wanted(step(), input) + "]");
      fault(from, "'" + from.text + "' gives " + gives + ", which fits none of its inputs.",
            want.empty() ? "It has none." : "Inputs: " + joined(want) + ".");
    } else {
      std::vector<std::string> which;
      for (const auto& [k, source] : fitting) {
        std::string text = inputs[k].name + ": " + from.text;
        if (source->wire.step >= 0 && sources->size() > 1)
          text +=
              "." +
              draft_.plan.steps[source->wire.step].description->outputs[source->wire.output].name;
        which.push_back(text);
      }
      fault(from, "'" + from.text + "' fits in more than one way.",
            "Name the input: {" + joined(which, "} or {") + "}.");
    }
  }

  /// A list serves the one input that takes several.
  void bind_list(const Node& from) {
    std::vector<std::size_t> several;
    for (std::size_t k = 0; k < planned_.inputs.size(); ++k)
      if (planned_.description->inputs[k].access == Access::several) several.push_back(k);
    if (several.size() == 1) return bind_several(several[0], from);
    mark(from);
    fault(from,
          several.empty() ? "none of its inputs takes a list."
                          : "more than one of its inputs takes a list.",
          "Name the inputs: " + joined(ports()) + ".");
  }

  void bind_ports(const Node& from) {
    for (const Entry& entry : from.entries) {
      const auto& inputs = planned_.description->inputs;
      const auto input = std::find_if(inputs.begin(), inputs.end(),
                                      [&](const auto& i) { return i.name == entry.key; });
      if (input == inputs.end()) {
        faulty_ = true;
        draft_.fault(entry.origin, title_ + ": it has no input '" + entry.key + "'.",
                     did_you_mean(entry.key, ports()));
        mark(entry.value);
        continue;
      }
      const auto index = static_cast<std::size_t>(input - inputs.begin());
      if (input->access == Access::several && !entry.value.is_scalar())
        bind_several(index, entry.value);
      else
        bind_port(index, entry.value);
    }
  }

  void bind_several(std::size_t input, const Node& from) {
    for (const Node& item : from.items) bind_port(input, item);
    for (const Entry& entry : from.entries) bind_port(input, entry.value, entry.key);
    if (from.items.empty() && from.entries.empty())
      fault(from, "expected names of steps, found " + from.shown() + " without any.");
  }

  void bind_port(std::size_t index, const Node& reference, const std::string& label = "") {
    const InputDescription& input = planned_.description->inputs[index];
    const auto sources = sources_of(draft_, scope_, reference);
    if (!sources) return void(faulty_ = true);
    std::vector<const Source*> fitting;
    std::string gives;
    for (const Source& source : *sources) {
      if (fits(step(), input, source)) fitting.push_back(&source);
      gives += (gives.empty() ? "" : " and ") + kind_of(*source.type, source.grain);
    }
    if (fitting.size() == 1) return wire(index, *fitting[0], label);
    for (const Source& source : *sources)
      if (source.wire.step >= 0) draft_.steps[source.wire.step].used = true;
    if (fitting.empty())
      fault(reference,
            "its input '" + input.name + "' wants " + wanted(step(), input) + ", but '" +
                reference.text + "' gives " + gives + ".",
            candidates(input));
    else
      fault(reference,
            "several outputs of '" + reference.text + "' fit its input '" + input.name + "'.",
            "Write " + reference.text + ".OUTPUT.");
  }

  /// Without a label it is what the source is called.
  void wire(std::size_t input, const Source& source, const std::string& given = "") {
    if (!choose(draft_, source)) return void(faulty_ = true);
    const std::string& label = given.empty() ? source.wire.label : given;
    auto& wires = planned_.inputs[input];
    for (const Wire& other : wires)
      if (other.label == label) {
        faulty_ = true;
        return draft_.fault(source.wire.origin, title_ + ": '" + label + "' is there twice.",
                            "Label them: {label: step}.");
      }
    wires.push_back(source.wire);
    wires.back().label = label;
  }

  Draft& draft_;
  int step_, scope_;
  PlannedStep& planned_;
  std::string title_;
  bool faulty_ = false;  // an input is wrong: which ones are missing cannot be said
};

}  // namespace

void read_wires(Draft& draft) {
  for (std::size_t k = 0; k < draft.steps.size(); ++k) Binder(draft, static_cast<int>(k)).bind();
}

}  // namespace plumb::pipeline
