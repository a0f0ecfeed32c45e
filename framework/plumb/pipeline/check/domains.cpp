/// Finds for every step which items it has: the step whose output says so. Values of one call must
/// belong to the same items.
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

class Domains {
 public:
  explicit Domains(Draft& draft) : draft_(draft) {}

  void walk(const std::vector<PlannedItem>& items) {
    for (const PlannedItem& item : items) {
      if (item.step >= 0)
        find(item.step);
      else
        walk(draft_.plan.repeats[item.repeat].body);
    }
  }

 private:
  void find(int index) {
    PlannedStep& step = draft_.plan.steps[index];
    if (!step.description) return;
    const ItemKind* own = step.description->items;
    std::map<const ItemKind*, Domain> domains;
    for (std::size_t k = 0; k < step.inputs.size(); ++k) {
      const InputDescription& input = step.description->inputs[k];
      for (const Wire& wire : step.inputs[k]) {
        if (step.description->lists_items(input)) {
          if (wire.step < 0)
            draft_.fault(wire.origin, draft_.title(index) + ": which " + own->name +
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

  /// The step whose output says which items the values on a wire belong to; -1 for a value of the
  /// whole pipeline.
  int domain_of(const Wire& wire) const {
    if (wire.step < 0) return -1;  // carried values are whole
    const PlannedStep& source = draft_.plan.steps[wire.step];
    const OutputDescription& output = source.description->outputs[wire.output];
    if (output.emission == Emission::one)
      return source.description->itemwise() ? source.domain : -1;
    for (std::size_t k = 0; k < source.inputs.size(); ++k)
      if (source.description->inputs[k].name == output.over && !source.inputs[k].empty())
        return domain_of(source.inputs[k].front());
    return wire.step;
  }

  void agree(int index, Domain& domain, int step, const std::string& port, const Wire& wire) {
    if (domain.step < 0) domain = {step, port, &wire};
    if (domain.step == step) return;
    draft_.fault(wire.origin,
                 draft_.title(index) + ": its inputs '" + domain.port + "' and '" + port +
                     "' belong to different items: those of '" +
                     draft_.plan.steps[domain.step].path + "' and those of '" +
                     draft_.plan.steps[step].path + "'.",
                 "Wire both to steps that work on the same ones.  '" + domain.port +
                     "' is wired at " + domain.wire->origin.text() + ".");
  }

  void settle(int index, const Domain& domain, const std::string& items) {
    PlannedStep& step = draft_.plan.steps[index];
    step.domain = domain.step;
    bool wired = false;
    for (const auto& wires : step.inputs) wired = wired || !wires.empty();
    if (domain.step < 0 && wired && draft_.diagnostics.empty())
      draft_.fault(step.origin, draft_.title(index) + ": nothing that it is wired to says which " +
                                    items + " there are.");
  }

  Draft& draft_;
};

}  // namespace

void find_domains(Draft& draft) { Domains(draft).walk(draft.plan.order); }

}  // namespace plumb::pipeline
