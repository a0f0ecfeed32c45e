/// Fills every step's parameters: from `with`, from a row, from the pipeline's parameters, or with
/// the declared default.
#include "plumb/pipeline/bind/binding.hpp"
#include "plumb/pipeline/bind/former.hpp"
#include "plumb/pipeline/bind/values.hpp"

namespace plumb::pipeline {
namespace {

class Parameters {
 public:
  Parameters(const Declared& declared, Reading& reading) : declared_(declared), reading_(reading) {
    for (const DeclaredRepeat& repeat : declared.repeats) {
      auto& rows = bound_.rows.emplace_back();
      for (const DeclaredRow& row : repeat.passes.rows)
        rows.push_back({row.name, {}, ParameterKind::number, Quantity::none, row.origin});
    }
  }

  BoundParameters read() {
    for (std::size_t k = 0; k < declared_.steps.size(); ++k)
      bound_.of_steps.push_back(of_step(static_cast<int>(k)));
    return std::move(bound_);
  }

 private:
  std::vector<OrFaulty<PlannedParameter>> of_step(int index) {
    std::vector<OrFaulty<PlannedParameter>> all;
    const DeclaredStep& step = declared_.steps[index];
    const Node* with = step.node->at("with");
    if (with && !with->is_map())
      reading_.fault(with->origin, step.title() + ": 'with' is a map of parameters, found " +
                                       with->shown() + ".");
    if (!step.use) {
      if (with) mark_references(*with, step.repeat);
      return all;
    }
    for (const ParameterDescription& parameter : step.use->description->parameters) {
      const Node* node = with ? with->at(parameter.name) : nullptr;
      all.push_back(node ? given(index, parameter, *node) : left_out(step, parameter));
    }
    if (with) refuse_unknown(step, *with);
    return all;
  }

  OrFaulty<PlannedParameter> left_out(const DeclaredStep& step,
                                      const ParameterDescription& parameter) {
    if (!parameter.required) return PlannedParameter{parameter.standard, {}};
    if (!step.misspelt)
      reading_.fault(step.origin,
                     step.title() + ": parameter '" + parameter.name + "' is missing, " +
                         expected(parameter) + ".",
                     parameter.doc.empty() ? "" : "It is " + parameter.doc + ".");
    return Faulty();
  }

  OrFaulty<PlannedParameter> given(int index, const ParameterDescription& parameter,
                                   const Node& node) {
    const DeclaredStep& step = declared_.steps[index];
    const std::string place = step.title() + ": parameter '" + parameter.name + "'";
    note_choices(reading_, declared_, index, parameter, node);
    if (const auto reference = reference_in(node)) {
      const std::string name =
          row_or_setting_of_now(reading_, declared_, node, *reference, step.repeat);
      if (const auto row = find_row(declared_, name, step.repeat))
        return of_row(place, parameter, row->first, row->second);
    }
    const auto value = value_of(reading_, declared_.settings, place, parameter, node);
    if (!value) return Faulty();
    return PlannedParameter{value->value, value->origin};
  }

  /// Reads a row for one more parameter that it drives; the first one says what it holds.
  OrFaulty<PlannedParameter> of_row(const std::string& place, const ParameterDescription& parameter,
                                    int repeat, int index) {
    PlannedRow& row = bound_.rows[repeat][index];
    const auto& nodes = declared_.repeats[repeat].passes.rows[index].values;
    reading_.uses.rows.insert({repeat, index});
    const bool first = driving_.insert({repeat, index}).second;
    if (!first && (row.kind != parameter.kind || row.quantity != parameter.quantity)) {
      reading_.fault(row.origin,
                     place + ": the row '" + row.name + "' drives " + expected(parameter) +
                         " here and something else elsewhere.",
                     "Use two rows.");
      return Faulty();
    }
    row.kind = parameter.kind;
    row.quantity = parameter.quantity;
    std::vector<ParameterValue> values;
    for (const Node* node : nodes) {
      const auto value = value_of(reading_, declared_.settings, place + ": row '" + row.name + "'",
                                  parameter, *node);
      if (value) values.push_back(value->value);
    }
    if (values.size() != nodes.size() || values.empty()) return Faulty();
    row.values = std::move(values);
    return PlannedParameter{row.values.front(), row.origin, repeat, index};
  }

  void refuse_unknown(const DeclaredStep& step, const Node& with) {
    const StepDescription& description = *step.use->description;
    std::vector<std::string> known;
    known.reserve(description.parameters.size());
    for (const ParameterDescription& parameter : description.parameters)
      known.push_back(parameter.name);
    for (const Entry& entry : with.entries) {
      if (description.parameter(entry.key)) continue;
      const std::string near = nearest(entry.key, known);
      std::string hint = near.empty() ? ""
                                      : "Did you mean '" + near + "' [" +
                                            range_text(*description.parameter(near)) + "]?  ";
      hint += known.empty() ? "It has none." : "Known: " + joined(known) + ".";
      reading_.fault(entry.origin, step.title() + ": unknown parameter '" + entry.key + "'.", hint);
      mark_references(entry.value, step.repeat);
    }
  }

  /// Of what no module offers: what its values refer to counts as used, so that one mistake does
  /// not cause more.
  void mark_references(const Node& node, int repeat) {
    for (const Node& item : node.items) mark_references(item, repeat);
    for (const Entry& entry : node.entries) mark_references(entry.value, repeat);
    const auto name = reference_in(node);
    if (!name) return;
    if (declared_.settings.contains(*name)) reading_.uses.settings.insert(*name);
    for (; repeat >= 0; repeat = declared_.repeats[repeat].parent) {
      const auto& rows = declared_.repeats[repeat].passes.rows;
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k].name == *name) reading_.uses.rows.insert({repeat, static_cast<int>(k)});
    }
  }

  const Declared& declared_;
  Reading& reading_;
  BoundParameters bound_;
  std::set<Uses::InRepeat> driving_;  ///< rows of which it is known what they hold
};

}  // namespace

BoundParameters parameters_of(const Declared& declared, Reading& reading) {
  return Parameters(declared, reading).read();
}

}  // namespace plumb::pipeline
