/// Finds for every step which items it has: the step whose output says so. Values of one call must
/// belong to the same items.
#include <algorithm>
#include <map>

#include "plumb/pipeline/check/checks.hpp"

namespace plumb::pipeline {
namespace {

/// Where the items of one kind come from, and the wire that said so first.
struct Domain {
  int step = -1;
  std::string port;
  const Wire* wire = nullptr;
};

/// The wire of an input that takes one; null: none, or it is faulty.
const Wire* first_of(const std::vector<OrFaulty<Wire>>& wires) {
  const auto sound = std::find_if(wires.begin(), wires.end(),
                                  [](const OrFaulty<Wire>& wire) { return bool(wire); });
  return sound == wires.end() ? nullptr : &**sound;
}

class DomainFinder {
 public:
  DomainFinder(const Bound& bound, const Order& order, Diagnostics& diagnostics)
      : bound_(bound), order_(order), diagnostics_(diagnostics), domains_(bound.steps.size(), -1) {}

  Domains find() {
    walk(order_.items);
    return std::move(domains_);
  }

 private:
  void walk(const std::vector<PlannedItem>& items) {
    for (const PlannedItem& item : items) {
      if (item.step >= 0)
        find(item.step);
      else
        walk(order_.bodies[item.repeat]);
    }
  }

  void find(int index) {
    if (!bound_.steps[index]) return;
    const BoundStep& step = *bound_.steps[index];
    const ItemKind* own = step.description->items;
    std::map<const ItemKind*, Domain> domains;
    for (std::size_t k = 0; k < step.inputs.size(); ++k) {
      const InputDescription& input = step.description->inputs[k];
      for (const OrFaulty<Wire>& wired : step.inputs[k]) {
        if (!wired) continue;
        const Wire& wire = *wired;
        if (step.description->lists_items(input)) {
          if (wire.step < 0)
            diagnostics_.add(wire.origin, title(index) + ": which " + own->name +
                                              "s there are must come from a step, not from what a "
                                              "repeat carries.");
          else
            agree(index, domains[own], wire.step, input.name, wire);
          continue;
        }
        const int domain = domain_of(wire);
        if (domain < 0) continue;
        // Its own parts a step takes by its item's range, not item by item.
        if (input.access == Access::each && own) continue;
        const ItemKind* of = input.access == Access::item && own ? own : input.type->kind;
        agree(index, domains[of], domain, input.name, wire);
      }
    }
    if (own) settle(index, domains[own], own->name + "s");
  }

  std::string title(int step) const { return bound_.declared.steps[step].title(); }

  /// The step whose output says which items the values on a wire belong to; -1 for a value of the
  /// whole pipeline.
  int domain_of(const Wire& wire) const {
    if (wire.step < 0) return -1;  // carried values are whole
    const BoundStep& source = *bound_.steps[wire.step];
    const OutputDescription& output = source.description->outputs[wire.output];
    if (output.emission == Emission::one)
      return source.description->itemwise() ? domains_[wire.step] : -1;
    for (std::size_t k = 0; k < source.inputs.size(); ++k)
      if (source.description->inputs[k].name == output.over)
        if (const Wire* over = first_of(source.inputs[k])) return domain_of(*over);
    return wire.step;
  }

  void agree(int index, Domain& domain, int step, const std::string& port, const Wire& wire) {
    if (domain.step < 0) domain = {step, port, &wire};
    if (domain.step == step) return;
    const auto& steps = bound_.declared.steps;
    diagnostics_.add(wire.origin,
                     title(index) + ": its inputs '" + domain.port + "' and '" + port +
                         "' belong to different items: those of '" + steps[domain.step].path +
                         "' and those of '" + steps[step].path + "'.",
                     "Wire both to steps that work on the same ones.  '" + domain.port +
                         "' is wired at " + domain.wire->origin.text() + ".");
  }

  void settle(int index, const Domain& domain, const std::string& items) {
    domains_[index] = domain.step;
    bool wired = false;
    for (const auto& wires : bound_.steps[index]->inputs)
      wired = wired || first_of(wires) != nullptr;
    if (domain.step < 0 && wired && diagnostics_.empty())
      diagnostics_.add(
          bound_.declared.steps[index].origin,
          title(index) + ": nothing that it is wired to says which " + items + " there are.");
  }

  const Bound& bound_;
  const Order& order_;
  Diagnostics& diagnostics_;
  Domains domains_;
};

}  // namespace

Domains domains_of(const Bound& bound, const Order& order, Diagnostics& diagnostics) {
  return DomainFinder(bound, order, diagnostics).find();
}

}  // namespace plumb::pipeline
