/// What is written and used by nothing is a mistake: somebody believes that it matters.
#include <algorithm>

#include "plumb/data/document.hpp"
#include "plumb/pipeline/check/checks.hpp"

namespace plumb::pipeline {
namespace {

/// Documents go into the output folder and numbers into the report, without any wire.
bool leaves_something(const StepDescription& step) {
  return std::any_of(step.outputs.begin(), step.outputs.end(), [](const OutputDescription& output) {
    return output.type == &type_of<Document>() || output.type->has_numbers;
  });
}

bool without_a_line(const Origin& origin) { return origin.line == 0; }

std::string left_without_use(const Origin& origin, const std::string& what) {
  return origin.text() + ": warning: nothing uses the " + what +
         " any more, so that this sets nothing; what it served has another value, from a preset or "
         "from another --set.";
}

/// Calls `act(name, setting)` for each parameter of the pipeline that nothing uses.
template <class Act>
void for_each_unused_setting(const Bound& bound, const Act& act) {
  for (const auto& [name, setting] : bound.declared.settings)
    if (!bound.uses.settings.contains(name)) act(name, setting);
}

/// Calls `act(row)` for each row of a repeat that nothing uses.
template <class Act>
void for_each_unused_row(const Bound& bound, int repeat, const Act& act) {
  const auto& rows = bound.declared.repeats[repeat].passes.rows;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!bound.uses.rows.contains({repeat, static_cast<int>(k)})) act(rows[k]);
}

/// Whether an overlay left it without a use: that is no mistake.
bool was_used(const Bound& bound, const std::string& path) {
  return bound.declared.loaded->referenced.contains(path);
}

void check_settings(const Bound& bound, Diagnostics& diagnostics) {
  for_each_unused_setting(bound, [&](const std::string& name, const Setting& setting) {
    if (!was_used(bound, name))
      diagnostics.add(setting.declared, "nothing uses the parameter '" + name + "'.",
                      "Write $" + name + " where its value belongs, or remove it.");
  });
}

void check_rows(const Bound& bound, int index, Diagnostics& diagnostics) {
  const DeclaredRepeat& repeat = bound.declared.repeats[index];
  for_each_unused_row(bound, index, [&](const DeclaredRow& row) {
    if (!was_used(bound, repeat.path + "." + row.name))
      diagnostics.add(row.origin,
                      "repeat '" + repeat.path + "': no step uses the row '" + row.name + "'.",
                      "Write $" + row.name + " in a step of the body, or remove the row.");
  });
}

void check_carries(const Bound& bound, int index, Diagnostics& diagnostics) {
  const DeclaredRepeat& repeat = bound.declared.repeats[index];
  const auto& carries = repeat.passes.carries;
  for (std::size_t k = 0; k < carries.size(); ++k)
    if (!bound.uses.carries.contains({index, static_cast<int>(k)}))
      diagnostics.add(
          carries[k].next->origin,
          "repeat '" + repeat.path + "': no step uses '" + carries[k].name + "', which is carried.",
          "Wire it to a step of the body, or do not carry it.");
}

void check_steps(const Bound& bound, Diagnostics& diagnostics) {
  for (std::size_t k = 0; k < bound.steps.size(); ++k) {
    const OrFaulty<BoundStep>& step = bound.steps[k];
    if (!step || bound.uses.steps.contains(static_cast<int>(k)) ||
        leaves_something(*step->description))
      continue;
    const DeclaredStep& declared = bound.declared.steps[k];
    diagnostics.add(declared.origin, declared.title() + ": nothing uses what it makes.",
                    "Wire its output to a step that writes or measures, or remove it.");
  }
}

}  // namespace

void check_unused(const Bound& bound, bool judged, Diagnostics& diagnostics) {
  if (bound.uses.dangling) return;  // it may be what was meant
  if (!judged) check_settings(bound, diagnostics);
  for (std::size_t k = 0; k < bound.repeats.size(); ++k) {
    if (!judged) check_rows(bound, static_cast<int>(k), diagnostics);
    check_carries(bound, static_cast<int>(k), diagnostics);
  }
  if (!judged) check_steps(bound, diagnostics);
}

std::vector<std::string> warnings_of(const Bound& bound) {
  std::vector<std::string> warnings;
  for_each_unused_setting(bound, [&](const std::string& name, const Setting& setting) {
    if (setting.value && without_a_line(setting.value->origin))
      warnings.push_back(left_without_use(setting.value->origin, "parameter '" + name + "'"));
  });
  for (std::size_t k = 0; k < bound.repeats.size(); ++k)
    for_each_unused_row(bound, static_cast<int>(k), [&](const DeclaredRow& row) {
      if (without_a_line(row.origin))
        warnings.push_back(left_without_use(
            row.origin, "row '" + bound.declared.repeats[k].path + "." + row.name + "'"));
    });
  return warnings;
}

}  // namespace plumb::pipeline
