/// Reads `until`: when a repeat may end before its passes are used up.
#include <cmath>

#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {
namespace {

class Conditions {
 public:
  Conditions(Draft& draft, int repeat)
      : draft_(draft),
        repeat_(repeat),
        planned_(draft.plan.repeats[repeat]),
        what_("repeat '" + planned_.path + "': 'until'") {}

  void read(const Node& until) {
    if (!check_keys(draft_, until, what_, {"all", "any"})) return;
    if (until.entries.size() != 1)
      return draft_.fault(until.origin, what_ + " takes one of 'all' and 'any'.",
                          "As in until: {all: [{metric: rmse, falls_by_less_than: 2 %}]}.");
    planned_.all = until.entries[0].key == "all";
    const Node& list = until.entries[0].value;
    if (!list.is_list() || list.items.empty())
      return draft_.fault(list.origin,
                          what_ + ": expected a list of conditions, found " + list.shown() + ".");
    for (const Node& item : list.items) read_condition(item);
  }

 private:
  void read_condition(const Node& node) {
    if (!check_keys(draft_, node, what_, {"metric", "falls_by_less_than", "below"})) return;
    const Node* metric = node.at("metric");
    const Node* falls = node.at("falls_by_less_than");
    const Node* below = node.at("below");
    if (!metric || !falls == !below)
      return draft_.fault(
          node.origin,
          what_ + ": a condition has 'metric' and one of 'falls_by_less_than' and 'below'.");
    PlannedCondition condition;
    condition.origin = node.origin;
    find_metric(*metric, condition);
    if (falls)
      condition.falls_by_less_than = share(*falls);
    else
      condition.below = bound(*below);
    condition.metric_text = text_of_now(draft_, *metric);
    condition.text = condition.metric_text +
                     (falls ? " falls by less than " + falls->text : " is below " + below->text);
    planned_.conditions.push_back(std::move(condition));
  }

  std::optional<double> share(const Node& node) {
    ParameterDescription type;
    type.quantity = Quantity::ratio;
    type.low = 0;
    type.high = 1;
    const auto value = value_of(draft_, what_ + ": 'falls_by_less_than'", type, node, -1, nullptr);
    return value && std::holds_alternative<double>(*value) ? std::optional(std::get<double>(*value))
                                                           : std::nullopt;
  }

  /// In the metric's own unit, which only the run knows: any unit is taken.
  std::optional<double> bound(const Node& node) {
    ParameterDescription type;
    type.low = -INFINITY;
    type.high = INFINITY;
    if (const auto name = reference_in(node)) {
      const auto setting = draft_.settings.find(*name);
      if (setting != draft_.settings.end()) type.quantity = setting->second.type.quantity;
    } else if (node.is_scalar()) {
      const auto number = read_number(node.text);
      if (const auto* measured = std::get_if<Measured>(&number)) {
        if (measured->unit) type.quantity = measured->unit->quantity;
      } else {
        const Fault& fault = std::get<Fault>(number);
        draft_.fault(node.origin, what_ + ": 'below': " + fault.sentence + ".", fault.hint);
        return std::nullopt;
      }
    }
    const auto value = value_of(draft_, what_ + ": 'below'", type, node, -1, nullptr);
    return value && std::holds_alternative<double>(*value) ? std::optional(std::get<double>(*value))
                                                           : std::nullopt;
  }

  /// How much of "inner.rmse.within" names a step, seen from the body; 0 when nothing does.
  std::size_t length_of_step(const std::string& text) const {
    int scope = draft_.repeats[repeat_].body;
    std::size_t begin = 0;
    for (bool first = true; scope >= 0; first = false) {
      const std::size_t end = std::min(text.find('.', begin), text.size());
      const std::string name = text.substr(begin, end - begin);
      while (first && scope >= 0 && !draft_.scopes[scope].names.count(name))
        scope = draft_.scopes[scope].parent;
      if (scope < 0) return 0;
      const auto at = draft_.scopes[scope].names.find(name);
      if (at == draft_.scopes[scope].names.end()) return 0;
      if (at->second.kind == Symbol::Kind::step) return end;
      if (at->second.kind == Symbol::Kind::carry || end == text.size()) return 0;
      scope = at->second.kind == Symbol::Kind::group ? at->second.index
                                                     : draft_.repeats[at->second.index].body;
      begin = end + 1;
    }
    return 0;
  }

  /// The step's only Metrics output, unless a port is named; what is left names the number.
  void find_metric(const Node& metric, PlannedCondition& condition) {
    Node step = metric;
    const std::size_t length = metric.is_scalar() ? length_of_step(metric.text) : 0;
    if (length > 0) step.text = metric.text.substr(0, length);
    const auto sources = sources_of(draft_, draft_.repeats[repeat_].body, step);
    if (!sources) return;
    std::string rest =
        length > 0 && length < metric.text.size() ? metric.text.substr(length + 1) : "";
    std::vector<const Source*> fitting;
    for (const Source& source : *sources) {
      if (!source.type->has_numbers || source.grain || source.wire.step < 0) continue;
      const StepDescription& giver = *draft_.plan.steps[source.wire.step].description;
      const std::string& port = giver.outputs[source.wire.output].name;
      const std::string word = rest.substr(0, rest.find('.'));
      const auto now = draft_.names.output(giver, word);
      if (now.value_or(word) == port) {
        fitting = {&source};
        rest.erase(0, word.size());
        if (now) rename(draft_, metric, step.text + "." + port + rest);
        rest.erase(0, 1);
        break;
      }
      fitting.push_back(&source);
    }
    if (fitting.size() != 1)
      return draft_.fault(
          metric.origin,
          what_ + ": '" + step.text + "' gives " +
              (fitting.empty() ? "no Metrics." : "several Metrics."),
          fitting.empty() ? "Name a step that measures." : "Write " + step.text + ".OUTPUT.");
    choose(draft_, *fitting[0]);
    condition.step = fitting[0]->wire.step;
    condition.output = fitting[0]->wire.output;
    condition.metric = rest;
    if (!inside(draft_, draft_.steps[condition.step].repeat, repeat_))
      draft_.fault(metric.origin, what_ + ": '" + step.text +
                                      "' is not in the body, so it is the same after every pass.");
  }

  Draft& draft_;
  int repeat_;
  PlannedRepeat& planned_;
  std::string what_;
};

}  // namespace

void read_conditions(Draft& draft) {
  for (std::size_t k = 0; k < draft.repeats.size(); ++k) {
    const Node* repeat = draft.repeats[k].node->at("repeat");
    if (const Node* until = repeat->at("until"))
      Conditions(draft, static_cast<int>(k)).read(*until);
  }
}

}  // namespace plumb::pipeline
