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

bool from_command_line(const Origin& origin) { return origin.line == 0; }

std::string left_without_use(const Origin& origin, const std::string& what) {
  return origin.text() + ": warning: nothing uses the " + what +
         " any more, so that this sets nothing; what it served has another value, from a preset or "
         "from another --set.";
}

}  // namespace

/// What an overlay or --set left without a use is no mistake; to set it on the command line all the
/// same is worth a warning.
void find_unused(Draft& draft) {
  if (draft.dangling) return;  // it may be what was meant
  for (const auto& [name, setting] : draft.settings) {
    if (setting.used) continue;
    if (!draft.referenced.contains(name))
      draft.fault(setting.declared, "nothing uses the parameter '" + name + "'.",
                  "Write $" + name + " where its value belongs, or remove it.");
    else if (from_command_line(setting.origin))
      draft.plan.warnings.push_back(left_without_use(setting.origin, "parameter '" + name + "'"));
  }
  for (std::size_t r = 0; r < draft.repeats.size(); ++r) {
    const PlannedRepeat& repeat = draft.plan.repeats[r];
    for (std::size_t k = 0; k < repeat.rows.size(); ++k) {
      const PlannedRow& row = repeat.rows[k];
      if (draft.repeats[r].rows[k].used) continue;
      if (!draft.referenced.contains(repeat.path + "." + row.name))
        draft.fault(row.origin,
                    "repeat '" + repeat.path + "': no step uses the row '" + row.name + "'.",
                    "Write $" + row.name + " in a step of the body, or remove the row.");
      else if (from_command_line(row.origin))
        draft.plan.warnings.push_back(
            left_without_use(row.origin, "row '" + repeat.path + "." + row.name + "'"));
    }
    for (std::size_t k = 0; k < repeat.carries.size(); ++k)
      if (!draft.repeats[r].carries[k].used)
        draft.fault(repeat.carries[k].next.origin,
                    "repeat '" + repeat.path + "': no step uses '" + repeat.carries[k].name +
                        "', which is carried.",
                    "Wire it to a step of the body, or do not carry it.");
  }
  for (std::size_t k = 0; k < draft.steps.size(); ++k) {
    const PlannedStep& step = draft.plan.steps[k];
    if (draft.steps[k].used || !step.description || leaves_something(*step.description)) continue;
    draft.fault(step.origin, draft.title(static_cast<int>(k)) + ": nothing uses what it makes.",
                "Wire its output to a step that writes or measures, or remove it.");
  }
}

}  // namespace plumb::pipeline
