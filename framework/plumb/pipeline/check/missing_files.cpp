/// A path that leads nowhere is noticed before anything runs. Steps write no files, so that every
/// path is something to read.
#include <algorithm>
#include <filesystem>
#include <set>

#include "plumb/data/io/fence.hpp"
#include "plumb/pipeline/check/checks.hpp"
#include "plumb/pipeline/check/given_paths.hpp"

namespace plumb::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_entries = 5000;  // of a folder that a mistyped name is looked up in

/// "Did you mean '...'?" from what lies beside, or the first folder of the path that is missing
/// too.
std::string cure(const fs::path& path) {
  std::error_code error;
  fs::path missing = path;
  while (missing.has_parent_path() && missing.parent_path() != missing &&
         !fs::exists(missing.parent_path(), error))
    missing = missing.parent_path();
  std::vector<std::string> beside;
  for (fs::directory_iterator at(missing.parent_path(), error), end;
       !error && at != end && beside.size() < most_entries; at.increment(error))
    beside.push_back(at->path().filename().string());
  std::sort(beside.begin(), beside.end());
  const std::string near = nearest(missing.filename().string(), beside);
  if (!near.empty()) return "Did you mean '" + (missing.parent_path() / near).string() + "'?";
  return missing == path ? "" : "There is no folder '" + missing.string() + "' either.";
}

/// A value of a step's path parameter.
struct NamedPath {
  int step;
  const ParameterDescription* type;
  std::string path;
  Origin origin;
};

/// Adds the value of a parameter, of one that a row drives each of `row`; those that were left open
/// are no paths.
void add_paths(int step, const ParameterDescription& type, const PlannedParameter& parameter,
               const std::vector<ParameterValue>* row, std::vector<NamedPath>& paths) {
  const auto add = [&](const ParameterValue& value) {
    const auto* path = std::get_if<std::string>(&value);
    if (path && !path->empty()) paths.push_back({step, &type, *path, parameter.origin});
  };
  if (type.kind != ParameterKind::path) return;
  if (!row) return add(parameter.value);
  for (const ParameterValue& value : *row) add(value);
}

std::vector<NamedPath> paths_of(const Bound& bound) {
  std::vector<NamedPath> paths;
  for (std::size_t k = 0; k < bound.steps.size(); ++k) {
    if (!bound.steps[k]) continue;
    const BoundStep& step = *bound.steps[k];
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      if (!step.parameters[p]) continue;
      const PlannedParameter& parameter = *step.parameters[p];
      const bool driven = parameter.row >= 0;
      add_paths(static_cast<int>(k), step.description->parameters[p], parameter,
                driven ? &bound.repeats[parameter.repeat].rows[parameter.row].values : nullptr,
                paths);
    }
  }
  return paths;
}

std::vector<NamedPath> paths_of(const Plan& plan) {
  std::vector<NamedPath> paths;
  for (std::size_t k = 0; k < plan.steps.size(); ++k) {
    const PlannedStep& step = plan.steps[k];
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      const PlannedParameter& parameter = step.parameters[p];
      const bool driven = parameter.row >= 0;
      add_paths(static_cast<int>(k), step.description->parameters[p], parameter,
                driven ? &plan.repeats[parameter.repeat].rows[parameter.row].values : nullptr,
                paths);
    }
  }
  return paths;
}

bool from_command_line(const Origin& origin) { return origin.file.starts_with("--set "); }

std::vector<fs::path> given_among(const std::vector<NamedPath>& paths) {
  std::vector<fs::path> given;
  for (const NamedPath& named : paths)
    if (from_command_line(named.origin)) given.emplace_back(named.path);
  return given;
}

void tell_foreign(const DeclaredStep& step, const NamedPath& named, Diagnostics& diagnostics) {
  diagnostics.add(named.origin,
                  step.title() + ": parameter '" + named.type->name + "': '" + named.path +
                      "' lies outside of what the command line gives this pipeline to read.",
                  "Give the path on the command line, as in --set input=DIR; or leave --untrusted "
                  "out if you trust the pipeline.");
}

void tell_missing(const DeclaredStep& step, const NamedPath& named, Diagnostics& diagnostics) {
  std::string hint = cure(named.path);
  const auto add = [&](const std::string& more) {
    hint += (hint.empty() ? "" : "  ") + more + ".";
  };
  if (!named.type->doc.empty()) add("Expected: " + named.type->doc);
  if (named.origin.line <= 0) add("Asked for at " + step.origin.text());
  diagnostics.add(named.origin,
                  step.title() + ": parameter '" + named.type->name +
                      "': there is no file or folder '" + named.path + "'.",
                  hint);
}

void check_paths(const Bound& bound, bool untrusted, Diagnostics& diagnostics) {
  const std::vector<NamedPath> paths = paths_of(bound);
  const std::vector<fs::path> given = untrusted ? given_among(paths) : std::vector<fs::path>();
  std::set<std::string> told;  // origin and path: once for a value that several steps take
  for (const NamedPath& named : paths) {
    if (named.origin.file.empty()) continue;
    std::error_code error;
    const bool foreign =
        untrusted && !from_command_line(named.origin) && !io::inside(named.path, given);
    if (!foreign && fs::exists(named.path, error)) continue;
    if (!told.insert(named.origin.text() + "\n" + named.path).second) continue;
    const DeclaredStep& step = bound.declared.steps[named.step];
    if (foreign)
      tell_foreign(step, named, diagnostics);
    else
      tell_missing(step, named, diagnostics);
  }
}

}  // namespace

void check_missing_files(const Bound& bound, Diagnostics& diagnostics) {
  check_paths(bound, false, diagnostics);
}
void check_foreign_paths(const Bound& bound, Diagnostics& diagnostics) {
  check_paths(bound, true, diagnostics);
}

}  // namespace plumb::pipeline

namespace plumb {

std::vector<std::filesystem::path> given_paths(const Plan& plan) {
  return pipeline::given_among(pipeline::paths_of(plan));
}

}  // namespace plumb
