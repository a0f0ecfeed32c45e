/// Reads `until`: when a repeat may end before its passes are used up.
#include <cmath>

#include "plumb/pipeline/bind/binding.hpp"
#include "plumb/pipeline/bind/values.hpp"

namespace plumb::pipeline {
namespace {

std::optional<double> number_in(const Value& value) {
  const auto* number = std::get_if<double>(&value.value);
  return number ? std::optional(*number) : std::nullopt;  // left open
}

class Conditions {
 public:
  Conditions(const Declared& declared, int repeat, References& references, Reading& reading)
      : declared_(declared),
        repeat_(repeat),
        references_(references),
        reading_(reading),
        what_("repeat '" + declared.repeats[repeat].path + "': 'until'") {}

  BoundConditions read(const Node& until) {
    if (!check_keys(reading_.diagnostics, until, what_, {"all", "any"})) return faulty();
    if (until.entries.size() != 1) {
      reading_.fault(until.origin, what_ + " takes one of 'all' and 'any'.",
                     "As in until: {all: [{metric: rmse, falls_by_less_than: 2 %}]}.");
      return faulty();
    }
    BoundConditions bound{until.entries[0].key == "all"};
    const Node& list = until.entries[0].value;
    if (!list.is_list() || list.items.empty()) {
      reading_.fault(list.origin,
                     what_ + ": expected a list of conditions, found " + list.shown() + ".");
      return faulty();
    }
    for (const Node& item : list.items) bound.conditions.push_back(condition_of(item));
    return bound;
  }

 private:
  static BoundConditions faulty() { return {true, {Faulty()}}; }

  OrFaulty<PlannedCondition> condition_of(const Node& node) {
    if (!check_keys(reading_.diagnostics, node, what_, {"metric", "falls_by_less_than", "below"}))
      return Faulty();
    const Node* metric = node.at("metric");
    const Node* falls = node.at("falls_by_less_than");
    const Node* below = node.at("below");
    if (!metric || !falls == !below) {
      reading_.fault(
          node.origin,
          what_ + ": a condition has 'metric' and one of 'falls_by_less_than' and 'below'.");
      return Faulty();
    }
    PlannedCondition condition;
    condition.origin = node.origin;
    const bool found = find_metric(*metric, condition);
    const OrFaulty<Value> value = falls ? share_of(*falls) : bound_of(*below);
    if (!found || !value) return Faulty();
    (falls ? condition.falls_by_less_than : condition.below) = number_in(*value);
    condition.metric_text = reading_.text_of_now(*metric);
    condition.text = condition.metric_text +
                     (falls ? " falls by less than " + falls->text : " is below " + below->text);
    return condition;
  }

  OrFaulty<Value> share_of(const Node& node) {
    ParameterDescription type;
    type.quantity = Quantity::ratio;
    type.low = 0;
    type.high = 1;
    return value_of(reading_, declared_.settings, what_ + ": 'falls_by_less_than'", type, node);
  }

  /// In the metric's own unit, which only the run knows: any unit is taken.
  OrFaulty<Value> bound_of(const Node& node) {
    ParameterDescription type;
    type.low = -INFINITY;
    type.high = INFINITY;
    if (const auto name = reference_in(node)) {
      const auto setting = declared_.settings.find(*name);
      if (setting != declared_.settings.end() && setting->second.value)
        type.quantity = setting->second.value->type.quantity;
    } else if (node.is_scalar()) {
      const auto number = read_number(node.text);
      if (const auto* measured = std::get_if<Measured>(&number)) {
        if (measured->unit) type.quantity = measured->unit->quantity;
      } else {
        const Fault& fault = std::get<Fault>(number);
        reading_.fault(node.origin, what_ + ": 'below': " + fault.sentence + ".", fault.hint);
        return Faulty();
      }
    }
    return value_of(reading_, declared_.settings, what_ + ": 'below'", type, node);
  }

  /// How much of "inner.rmse.within" names a step, seen from the body; 0 when nothing does.
  std::size_t length_of_step(const std::string& text) const {
    int scope = declared_.repeats[repeat_].body;
    std::size_t begin = 0;
    for (bool first = true; scope >= 0; first = false) {
      const std::size_t end = std::min(text.find('.', begin), text.size());
      const std::string name = text.substr(begin, end - begin);
      while (first && scope >= 0 && !declared_.scopes[scope].find(name))
        scope = declared_.scopes[scope].parent;
      if (scope < 0) return 0;
      const Symbol* at = declared_.scopes[scope].find(name);
      if (!at) return 0;
      if (at->kind == Symbol::Kind::step) return end;
      if (at->kind == Symbol::Kind::carry || end == text.size()) return 0;
      scope = at->kind == Symbol::Kind::group ? at->index : declared_.repeats[at->index].body;
      begin = end + 1;
    }
    return 0;
  }

  /// The step's only Metrics output, unless a port is named; what is left names the number. False
  /// when there is none (told).
  bool find_metric(const Node& metric, PlannedCondition& condition) {
    Node step = metric;
    const std::size_t length = metric.is_scalar() ? length_of_step(metric.text) : 0;
    if (length > 0) step.text = metric.text.substr(0, length);
    const auto sources = references_.sources(declared_.repeats[repeat_].body, step);
    if (!sources) return false;
    std::string rest =
        length > 0 && length < metric.text.size() ? metric.text.substr(length + 1) : "";
    std::vector<const Source*> fitting;
    for (const Source& source : *sources) {
      if (!source.type->has_numbers || source.grain || source.wire.step < 0) continue;
      const StepDescription& giver = *declared_.steps[source.wire.step].use->description;
      const std::string& port = giver.outputs[source.wire.output].name;
      const std::string word = rest.substr(0, rest.find('.'));
      const auto now = reading_.names.output(giver, word);
      if (now.value_or(word) == port) {
        fitting = {&source};
        rest.erase(0, word.size());
        if (now) reading_.rename(metric, step.text + "." + port + rest);
        rest.erase(0, 1);
        break;
      }
      fitting.push_back(&source);
    }
    if (fitting.size() != 1) {
      reading_.fault(
          metric.origin,
          what_ + ": '" + step.text + "' gives " +
              (fitting.empty() ? "no Metrics." : "several Metrics."),
          fitting.empty() ? "Name a step that measures." : "Write " + step.text + ".OUTPUT.");
      return false;
    }
    references_.choose(*fitting[0]);
    condition.step = fitting[0]->wire.step;
    condition.output = fitting[0]->wire.output;
    condition.metric = rest;
    if (inside(declared_, declared_.steps[condition.step].repeat, repeat_)) return true;
    reading_.fault(metric.origin, what_ + ": '" + step.text +
                                      "' is not in the body, so it is the same after every pass.");
    return false;
  }

  const Declared& declared_;
  int repeat_;
  References& references_;
  Reading& reading_;
  std::string what_;
};

}  // namespace

BoundConditions conditions_of(const Declared& declared, int repeat, References& references,
                              Reading& reading) {
  const Node* until = declared.repeats[repeat].node->at("repeat")->at("until");
  return until ? Conditions(declared, repeat, references, reading).read(*until) : BoundConditions();
}

}  // namespace plumb::pipeline
