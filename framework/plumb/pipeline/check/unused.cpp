/// What is written and used by nothing is a mistake: somebody believes that it matters.
#include <algorithm>

#include "plumb/pipeline/check/checks.hpp"

namespace plumb::pipeline {
namespace {

/// Documents go into the output folder and metrics into the report, without any wire.
bool leaves_something(const StepDescription& step) {
  return std::any_of(step.outputs.begin(), step.outputs.end(), [](const OutputDescription& output) {
    return output.type == &type_of<Document>() || output.type == &type_of<Metrics>();
  });
}

}  // namespace

void find_unused(Draft& draft) {
  if (draft.dangling) return;  // it may be what was meant
  for (const auto& [name, setting] : draft.settings)
    if (!setting.used)
      draft.fault(setting.declared, "nothing uses the parameter '" + name + "'.",
                  "Write $" + name + " where its value belongs, or remove it.");
  for (std::size_t r = 0; r < draft.repeats.size(); ++r) {
    const PlannedRepeat& repeat = draft.plan.repeats[r];
    for (std::size_t k = 0; k < repeat.rows.size(); ++k)
      if (!draft.repeats[r].rows[k].used)
        draft.fault(
            repeat.rows[k].origin,
            "repeat '" + repeat.path + "': no step uses the row '" + repeat.rows[k].name + "'.",
            "Write $" + repeat.rows[k].name + " in a step of the body, or remove the row.");
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
