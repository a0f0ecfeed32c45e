#include "plumb/slam/report/written_trajectory.hpp"

#include <algorithm>

#include "plumb/data/document.hpp"
#include "plumb/data/error.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/types.hpp"

namespace plumb {
namespace {

const ParameterValue* parameter_of(const PlannedStep& step, const std::string& name) {
  const ParameterDescription* described = step.description->parameter(name);
  if (!described) return nullptr;
  const auto place = static_cast<std::size_t>(described - step.description->parameters.data());
  return place < step.parameters.size() ? &step.parameters[place].value : nullptr;
}

/// Of a text or path; empty for none.
std::string text_in(const PlannedStep& step, const std::string& name) {
  const ParameterValue* value = parameter_of(step, name);
  const auto* text = value ? std::get_if<std::string>(value) : nullptr;
  return text ? *text : "";
}

double number_in(const PlannedStep& step, const std::string& name, double otherwise) {
  const ParameterValue* value = parameter_of(step, name);
  const auto* number = value ? std::get_if<double>(value) : nullptr;
  return number ? *number : otherwise;
}

bool same_source(const Wire& a, const Wire& b) {
  return a.step == b.step && a.output == b.output && a.repeat == b.repeat && a.carry == b.carry;
}

/// Whether a trajectory, or several, is what the step is given first.
bool takes_trajectory(const PlannedStep& step) {
  return !step.inputs.empty() && !step.inputs[0].empty() &&
         step.description->inputs[0].type == &type_of<Trajectory>();
}

bool gives(const PlannedStep& step, const Type& type) {
  return std::ranges::find(step.description->outputs, &type, &OutputDescription::type) !=
         step.description->outputs.end();
}

/// The last trajectory that a step measures by a truth, also over stretches of path; null for none.
const Wire* last_measured(const PlannedStep& step) {
  const bool measures = takes_trajectory(step) && gives(step, type_of<Metrics>()) &&
                        parameter_of(step, "truth") && parameter_of(step, "delta");
  return measures ? &step.inputs[0].back() : nullptr;
}

const PlannedStep* writer_of(const Plan& plan, const Wire* measured) {
  const PlannedStep* only = nullptr;
  int writers = 0;
  for (const PlannedStep& step : plan.steps) {
    if (!takes_trajectory(step) || !gives(step, type_of<Document>()) ||
        text_in(step, "format") != "tum")
      continue;
    if (measured && same_source(step.inputs[0][0], *measured)) return &step;
    only = &step, ++writers;
  }
  return !measured && writers == 1 ? only : nullptr;
}

void note_frames(const Plan& plan, WrittenTrajectory& to) {
  for (const PlannedStep& step : plan.steps) {
    if (!gives(step, type_of<Frame>()) || !gives(step, type_of<Trajectory>()) ||
        text_in(step, "coordinates") != "sensor")
      continue;
    to.frames = text_in(step, "path");
    const std::string odometry = text_in(step, "trajectory");
    to.odometry = odometry.empty() ? to.frames / "odometry.tum" : std::filesystem::path(odometry);
    return;
  }
}

}  // namespace

std::optional<WrittenTrajectory> written_trajectory(const Plan& plan, const RunResult& result) {
  const PlannedStep* measure = nullptr;
  for (const PlannedStep& step : plan.steps)
    if (last_measured(step)) measure = &step;
  const Wire* measured = measure ? last_measured(*measure) : nullptr;
  const PlannedStep* writer = writer_of(plan, measured);
  if (!writer) return std::nullopt;
  const auto made = std::ranges::find_if(result.documents, [&](const MadeDocument& document) {
    return document.path == writer->path;
  });
  if (made == result.documents.end()) return std::nullopt;
  WrittenTrajectory written;
  try {
    written.trajectory =
        parse_tum(made->document->bytes.text(), made->document->name, StampOrder::any);
  } catch (const Error&) {
    return std::nullopt;  // another module's idea of the format
  }
  if (measure) {
    written.prefix = measure->path + "." + (measured->label.empty() ? "" : measured->label + ".");
    written.truth = text_in(*measure, "truth");
    written.tolerance = number_in(*measure, "tolerance", written.tolerance);
    written.delta = number_in(*measure, "delta", written.delta);
  }
  note_frames(plan, written);
  return written;
}

}  // namespace plumb
