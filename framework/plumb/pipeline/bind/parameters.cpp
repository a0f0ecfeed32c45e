/// Fills every step's parameters: from `with`, from a row, from the pipeline's parameters, or with
/// the declared default.
#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {
namespace {

/// Of a step that no module offers: what its values refer to counts as used, so that one mistake
/// does not cause more.
void mark_references(Draft& draft, const Node& node, int repeat) {
  for (const Node& item : node.items) mark_references(draft, item, repeat);
  for (const Entry& entry : node.entries) mark_references(draft, entry.value, repeat);
  const auto name = reference_in(node);
  if (!name) return;
  if (const auto at = draft.settings.find(*name); at != draft.settings.end())
    at->second.used = true;
  for (; repeat >= 0; repeat = draft.repeats[repeat].parent)
    for (std::size_t k = 0; k < draft.repeats[repeat].rows.size(); ++k)
      if (draft.plan.repeats[repeat].rows[k].name == *name)
        draft.repeats[repeat].rows[k].used = true;
}

void read_step(Draft& draft, int index) {
  PlannedStep& planned = draft.plan.steps[index];
  const DraftStep& step = draft.steps[index];
  const std::string title = draft.title(index);
  const Node* with = step.node->at("with");
  if (with && !with->is_map())
    draft.fault(with->origin,
                title + ": 'with' is a map of parameters, found " + with->shown() + ".");
  if (!planned.description) {
    if (with) mark_references(draft, *with, step.repeat);
    return;
  }
  std::vector<std::string> known;
  for (const ParameterDescription& parameter : planned.description->parameters) {
    known.push_back(parameter.name);
    PlannedParameter filled;
    filled.value = parameter.standard;
    if (const Node* node = with ? with->at(parameter.name) : nullptr) {
      const auto value =
          value_of(draft, title + ": parameter '" + parameter.name + "'", parameter,
                   choice_of_now(draft, index, parameter, *node), step.repeat, &filled);
      if (value) filled.value = *value;
    } else if (parameter.required && !step.misspelt) {
      draft.fault(
          planned.origin,
          title + ": parameter '" + parameter.name + "' is missing, " + expected(parameter) + ".",
          parameter.doc.empty() ? "" : "It is " + parameter.doc + ".");
    }
    planned.parameters.push_back(std::move(filled));
  }
  if (!with) return;
  for (const Entry& entry : with->entries) {
    if (planned.description->parameter(entry.key)) continue;
    const std::string near = nearest(entry.key, known);
    std::string hint = near.empty()
                           ? ""
                           : "Did you mean '" + near + "' [" +
                                 range_text(*planned.description->parameter(near)) + "]?  ";
    hint += known.empty() ? "It has none." : "Known: " + joined(known) + ".";
    draft.fault(entry.origin, title + ": unknown parameter '" + entry.key + "'.", hint);
    mark_references(draft, entry.value, step.repeat);
  }
}

}  // namespace

void read_parameters(Draft& draft) {
  for (std::size_t k = 0; k < draft.steps.size(); ++k) read_step(draft, static_cast<int>(k));
}

}  // namespace plumb::pipeline
