/// Binds the ports of every step: by name, or the one port that fits.
#include <algorithm>

#include "plumb/pipeline/bind/binding.hpp"
#include "plumb/pipeline/bind/fitting.hpp"

namespace plumb::pipeline {
namespace {

using Inputs = std::vector<std::vector<OrFaulty<Wire>>>;

class Binder {
 public:
  Binder(const Declared& declared, int index, References& references, Reading& reading)
      : declared_(declared),
        index_(index),
        step_(declared.steps[index]),
        references_(references),
        reading_(reading) {}

  Inputs bind() {
    const Node* from = step_.node->at("from");
    if (!step_.use) {
      if (from) mark(*from);
      return {};
    }
    inputs_.resize(ports().size());
    if (from && from->is_map())
      bind_ports(*from);
    else if (from && from->is_list())
      bind_list(*from);
    else if (from)
      bind_one(*from);
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      if (inputs_[k].empty() && !ports()[k].optional) lacks(k);
    return std::move(inputs_);
  }

 private:
  const StepDescription& description() const { return *step_.use->description; }
  const std::vector<InputDescription>& ports() const { return description().inputs; }

  void lacks(std::size_t index) {
    const InputDescription& input = ports()[index];
    inputs_[index].push_back(Faulty());
    if (faulty_ || step_.misspelt) return;
    reading_.fault(step_.origin,
                   step_.title() + ": its input '" + input.name + "' is not wired, it wants " +
                       wanted(description(), input) + ".",
                   candidates(input));
  }

  /// Of a step that no module offers: what it refers to counts as used.
  void mark(const Node& from) {
    for (const Node& item : from.items) mark(item);
    for (const Entry& entry : from.entries) mark(entry.value);
    if (!from.is_scalar()) return;
    const auto sources = references_.sources(step_.scope, from);
    if (sources && sources->size() == 1)
      references_.choose(sources->front());
    else if (sources)
      mark(*sources);
  }
  void mark(const std::vector<Source>& sources) {
    for (const Source& source : sources)
      if (source.wire.step >= 0) reading_.uses.steps.insert(source.wire.step);
  }

  std::vector<std::string> names_of_ports() const {
    std::vector<std::string> names;
    names.reserve(ports().size());
    for (const InputDescription& input : ports()) names.push_back(input.name);
    return names;
  }

  /// Steps in sight that would fit a port.
  std::string candidates(const InputDescription& input) const {
    std::vector<std::string> names;
    for (int scope = step_.scope; scope >= 0; scope = declared_.scopes[scope].parent) {
      for (const auto& [name, symbol] : declared_.scopes[scope].names) {
        if (!symbol || symbol->kind != Symbol::Kind::step || symbol->index == index_) continue;
        const auto& use = declared_.steps[symbol->index].use;
        if (use && std::any_of(use->description->outputs.begin(), use->description->outputs.end(),
                               [&](const auto& o) { return o.type == input.type; }))
          names.push_back(name);
      }
    }
    return names.empty() ? ""
                         : "Of type " + std::string(input.type->name) + ": " + joined(names) + ".";
  }

  void fault(const Node& at, const std::string& sentence, const std::string& hint = "") {
    faulty_ = true;
    reading_.fault(at.origin, step_.title() + ": " + sentence, hint);
  }
  /// A reference to a port that cannot be followed.
  void give_up(std::size_t port) {
    faulty_ = true;
    inputs_[port].push_back(Faulty());
  }

  void bind_one(const Node& from) {
    const auto sources = references_.sources(step_.scope, from);
    if (!sources) return void(faulty_ = true);
    std::vector<std::pair<std::size_t, const Source*>> fitting;
    for (std::size_t k = 0; k < ports().size(); ++k)
      for (const Source& source : *sources)
        if (fits(description(), ports()[k], source)) fitting.emplace_back(k, &source);
    // `from: STEP` feeds what a step needs. An optional input is named where that fits as well, so
    // that a step may get one without a change to any pipeline; the scale of its lengths
    // (Declaration::scale) is named in any case.
    const auto optional = [&](const auto& fit) { return ports()[fit.first].optional; };
    std::erase_if(fitting, [&](const auto& fit) {
      return optional(fit) && ports()[fit.first].name == "scale";
    });
    if (!std::all_of(fitting.begin(), fitting.end(), optional)) std::erase_if(fitting, optional);
    if (fitting.size() == 1) return wire(fitting[0].first, *fitting[0].second);
    mark(*sources);
    if (!fitting.empty()) return ambiguous(from, fitting, sources->size() > 1);
    std::vector<std::string> want;
    want.reserve(ports().size());
    for (const InputDescription& input : ports())
      want.push_back("'" + input.name + "' [" + wanted(description(), input) + "]");
    fault(
        from,
        "'" + from.text + "' gives " + what_is_given(*sources) + ", which fits none of its inputs.",
        want.empty() ? "It has none." : "Inputs: " + joined(want) + ".");
  }

  void ambiguous(const Node& from,
                 const std::vector<std::pair<std::size_t, const Source*>>& fitting,
                 bool of_several) {
    std::vector<std::string> which;
    for (const auto& [k, source] : fitting) {
      std::string text = ports()[k].name + ": " + from.text;
      if (source->wire.step >= 0 && of_several) {
        const Use& giver = *declared_.steps[source->wire.step].use;
        text += "." + giver.description->outputs[source->wire.output].name;
      }
      which.push_back(text);
    }
    fault(from, "'" + from.text + "' fits in more than one way.",
          "Name the input: {" + joined(which, "} or {") + "}.");
  }

  static std::string what_is_given(const std::vector<Source>& sources) {
    std::string gives;
    for (const Source& source : sources)
      gives += (gives.empty() ? "" : " and ") + kind_of(*source.type, source.grain);
    return gives;
  }

  /// A list serves the one input that takes several.
  void bind_list(const Node& from) {
    std::vector<std::size_t> several;
    for (std::size_t k = 0; k < ports().size(); ++k)
      if (ports()[k].access == Access::several) several.push_back(k);
    if (several.size() == 1) return bind_several(several[0], from);
    mark(from);
    fault(from,
          several.empty() ? "none of its inputs takes a list."
                          : "more than one of its inputs takes a list.",
          "Name the inputs: " + joined(names_of_ports()) + ".");
  }

  void bind_ports(const Node& from) {
    for (const Entry& entry : from.entries) {
      const auto input = std::find_if(ports().begin(), ports().end(),
                                      [&](const auto& i) { return i.name == entry.key; });
      if (input == ports().end()) {
        faulty_ = true;
        reading_.fault(entry.origin, step_.title() + ": it has no input '" + entry.key + "'.",
                       did_you_mean(entry.key, names_of_ports()));
        mark(entry.value);
        continue;
      }
      const auto index = static_cast<std::size_t>(input - ports().begin());
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
    const InputDescription& input = ports()[index];
    const auto sources = references_.sources(step_.scope, reference);
    if (!sources) return give_up(index);
    std::vector<const Source*> fitting;
    for (const Source& source : *sources)
      if (fits(description(), input, source)) fitting.push_back(&source);
    if (fitting.size() == 1) return wire(index, *fitting[0], label);
    mark(*sources);
    give_up(index);
    if (fitting.empty())
      fault(reference,
            "its input '" + input.name + "' wants " + wanted(description(), input) + ", but '" +
                reference.text + "' gives " + what_is_given(*sources) + ".",
            candidates(input));
    else
      fault(reference,
            "several outputs of '" + reference.text + "' fit its input '" + input.name + "'.",
            "Write " + reference.text + ".OUTPUT.");
  }

  /// Without a label it is what the source is called.
  void wire(std::size_t input, const Source& source, const std::string& given = "") {
    if (!references_.choose(source)) return give_up(input);
    Wire labelled = source.wire;
    if (!given.empty()) labelled.label = given;
    for (const OrFaulty<Wire>& other : inputs_[input])
      if (other && other->label == labelled.label) {
        give_up(input);
        return reading_.fault(labelled.origin,
                              step_.title() + ": '" + labelled.label + "' is there twice.",
                              "Label them: {label: step}.");
      }
    inputs_[input].push_back(std::move(labelled));
  }

  const Declared& declared_;
  int index_;
  const DeclaredStep& step_;
  References& references_;
  Reading& reading_;
  Inputs inputs_;
  bool faulty_ = false;  // an input is wrong: which ones are missing cannot be said
};

}  // namespace

std::vector<Inputs> inputs_of(const Declared& declared, References& references, Reading& reading) {
  std::vector<Inputs> all;
  all.reserve(declared.steps.size());
  for (std::size_t k = 0; k < declared.steps.size(); ++k)
    all.push_back(Binder(declared, static_cast<int>(k), references, reading).bind());
  return all;
}

}  // namespace plumb::pipeline
