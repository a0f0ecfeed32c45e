/// A path that leads nowhere is noticed before anything runs. Steps write no files, so that every path is something to read.
#include <algorithm>
#include <filesystem>
#include <set>

#include "plumb/pipeline/draft.hpp"

namespace plumb::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_entries = 5000;  // of a folder that a mistyped name is looked up in

/// "Did you mean '...'?" from what lies beside, or the first folder of the path that is missing too.
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

class MissingFiles {
 public:
  explicit MissingFiles(Draft& draft) : draft_(draft) {}

  void find() {
    for (std::size_t k = 0; k < draft_.plan.steps.size(); ++k) {
      const PlannedStep& step = draft_.plan.steps[k];
      for (std::size_t p = 0; p < step.parameters.size(); ++p) {
        const ParameterDescription& type = step.description->parameters[p];
        const PlannedParameter& parameter = step.parameters[p];
        if (type.kind != ParameterKind::path) continue;
        if (parameter.row < 0)
          look(static_cast<int>(k), type, parameter.value, parameter.origin);
        else
          for (const auto& value : draft_.plan.repeats[parameter.repeat].rows[parameter.row].values)
            look(static_cast<int>(k), type, value, parameter.origin);
      }
    }
  }

 private:
  /// Told once for a value that several steps take.
  void look(int step, const ParameterDescription& type, const ParameterValue& value,
            const Origin& origin) {
    const auto* path = std::get_if<std::string>(&value);
    std::error_code error;
    if (!path || path->empty() || origin.file.empty() || fs::exists(*path, error)) return;
    if (!told_.insert(origin.text() + "\n" + *path).second) return;
    std::string hint = cure(*path);
    const auto add = [&](const std::string& more) { hint += (hint.empty() ? "" : "  ") + more + "."; };
    if (!type.doc.empty()) add("Expected: " + type.doc);
    if (origin.line <= 0) add("Asked for at " + draft_.plan.steps[step].origin.text());
    draft_.fault(origin,
                 draft_.title(step) + ": parameter '" + type.name +
                     "': there is no file or folder '" + *path + "'.",
                 hint);
  }

  Draft& draft_;
  std::set<std::string> told_;  // origin and path
};

}  // namespace

void find_missing_files(Draft& draft) { MissingFiles(draft).find(); }

}  // namespace plumb::pipeline
