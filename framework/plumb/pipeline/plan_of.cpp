#include "plumb/pipeline/plan_of.hpp"

#include "plumb/pipeline/print/resolved.hpp"

namespace plumb::pipeline {
namespace {

/// In the order written.
std::vector<PlannedSetting> settings_of(const Declared& declared) {
  std::vector<PlannedSetting> settings;
  const Node* parameters = declared.loaded->tree.at("parameters");
  if (!parameters) return settings;
  for (const std::string& name : parameters->keys()) {
    const Setting& setting = declared.settings.at(name);
    const SettingValue& given = setting.value.value();
    const Node* about = setting.node->at("about");
    settings.push_back(
        {name, about ? about->text : "", given.written ? given.written->text : "", given.origin});
  }
  return settings;
}

PlannedStep step_of(const DeclaredStep& declared, const BoundStep& bound, int domain) {
  PlannedStep step;
  step.path = declared.path;
  step.description = bound.description;
  step.origin = declared.origin;
  for (const auto& wires : bound.inputs) step.inputs.push_back(values_of(wires));
  step.parameters = values_of(bound.parameters);
  step.on_error = declared.use.value().on_error;
  step.domain = domain;
  return step;
}

PlannedRepeat repeat_of(const DeclaredRepeat& declared, const BoundRepeat& bound,
                        const std::vector<PlannedItem>& body) {
  const Counts& counts = declared.passes.counts.value();
  PlannedRepeat repeat;
  repeat.path = declared.path;
  repeat.origin = declared.origin;
  repeat.rows = bound.rows;
  repeat.carries = values_of(bound.carries);
  repeat.conditions = values_of(bound.conditions);
  repeat.all = bound.all;
  repeat.passes = counts.columns;
  repeat.at_least = counts.at_least;
  repeat.at_most = counts.at_most;
  repeat.if_exhausted = counts.if_exhausted;
  repeat.body = body;
  return repeat;
}

}  // namespace

Plan plan_of(const Bound& bound, const Order& order, const Domains& domains,
             std::vector<Renaming> renamings) {
  const Declared& declared = bound.declared;
  Plan plan;
  plan.name = declared.name;
  plan.about = declared.about;
  plan.files = declared.loaded->files;
  plan.settings = settings_of(declared);
  for (std::size_t k = 0; k < bound.steps.size(); ++k)
    plan.steps.push_back(step_of(declared.steps[k], bound.steps[k].value(), domains[k]));
  for (std::size_t k = 0; k < bound.repeats.size(); ++k)
    plan.repeats.push_back(repeat_of(declared.repeats[k], bound.repeats[k], order.bodies[k]));
  plan.order = order.items;
  plan.resolved = resolved_text(bound);
  plan.renamings = std::move(renamings);
  plan.warnings = warnings_of(bound);
  return plan;
}

}  // namespace plumb::pipeline
