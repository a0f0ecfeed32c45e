/// A path that leads nowhere is noticed before anything runs. Steps write no files, so that every
/// path is something to read.
#include <algorithm>
#include <filesystem>
#include <set>

#include "plumb/data/io/fence.hpp"
#include "plumb/pipeline/check/checks.hpp"

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

/// Calls `look(step, type, value, origin)` for each value of a path parameter.
template <class Look>
void for_each_path(const Plan& plan, const Look& look) {
  for (std::size_t k = 0; k < plan.steps.size(); ++k) {
    const PlannedStep& step = plan.steps[k];
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      const ParameterDescription& type = step.description->parameters[p];
      const PlannedParameter& parameter = step.parameters[p];
      if (type.kind != ParameterKind::path) continue;
      if (parameter.row < 0)
        look(static_cast<int>(k), type, parameter.value, parameter.origin);
      else
        for (const auto& value : plan.repeats[parameter.repeat].rows[parameter.row].values)
          look(static_cast<int>(k), type, value, parameter.origin);
    }
  }
}

bool from_command_line(const Origin& origin) { return origin.file.starts_with("--set "); }

class MissingFiles {
 public:
  MissingFiles(Draft& draft, bool untrusted) : draft_(draft), untrusted_(untrusted) {
    if (untrusted) given_ = given_paths(draft.plan);
  }

  void find() {
    for_each_path(draft_.plan,
                  [this](int step, const ParameterDescription& type, const ParameterValue& value,
                         const Origin& origin) { look(step, type, value, origin); });
  }

 private:
  /// Told once for a value that several steps take.
  void look(int step, const ParameterDescription& type, const ParameterValue& value,
            const Origin& origin) {
    const auto* path = std::get_if<std::string>(&value);
    std::error_code error;
    if (!path || path->empty() || origin.file.empty()) return;
    const bool foreign = untrusted_ && !from_command_line(origin) && !io::inside(*path, given_);
    if (!foreign && fs::exists(*path, error)) return;
    if (!told_.insert(origin.text() + "\n" + *path).second) return;
    if (foreign) {
      draft_.fault(origin,
                   draft_.title(step) + ": parameter '" + type.name + "': '" + *path +
                       "' lies outside of what the command line gives this pipeline to read.",
                   "Give the path on the command line, as in --set input=DIR; or leave --untrusted "
                   "out if you trust the pipeline.");
      return;
    }
    std::string hint = cure(*path);
    const auto add = [&](const std::string& more) {
      hint += (hint.empty() ? "" : "  ") + more + ".";
    };
    if (!type.doc.empty()) add("Expected: " + type.doc);
    if (origin.line <= 0) add("Asked for at " + draft_.plan.steps[step].origin.text());
    draft_.fault(origin,
                 draft_.title(step) + ": parameter '" + type.name +
                     "': there is no file or folder '" + *path + "'.",
                 hint);
  }

  Draft& draft_;
  bool untrusted_;
  std::vector<fs::path> given_;
  std::set<std::string> told_;  // origin and path
};

}  // namespace

void find_missing_files(Draft& draft) { MissingFiles(draft, false).find(); }
void find_foreign_paths(Draft& draft) { MissingFiles(draft, true).find(); }

}  // namespace plumb::pipeline

namespace plumb {

std::vector<std::filesystem::path> given_paths(const Plan& plan) {
  std::vector<std::filesystem::path> given;
  pipeline::for_each_path(plan, [&](int, const ParameterDescription&, const ParameterValue& value,
                                    const Origin& origin) {
    const auto* path = std::get_if<std::string>(&value);
    if (path && !path->empty() && pipeline::from_command_line(origin)) given.emplace_back(*path);
  });
  return given;
}

}  // namespace plumb
