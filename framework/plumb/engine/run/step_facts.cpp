/// What decided over the results of a step, as texts that can be compared with those of an earlier
/// run.
#include <sys/stat.h>
#include <time.h>

#include <cstdio>

#include "plumb/engine/run/step_run.hpp"

namespace plumb {
namespace {

std::string size_and_time(const std::string& path) {
  struct stat at {};
  if (stat(path.c_str(), &at) != 0) return "not there";
  char text[32];
  tm calendar{};
  gmtime_r(&at.st_mtim.tv_sec, &calendar);
  strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &calendar);
  char milliseconds[8];
  std::snprintf(milliseconds, sizeof milliseconds, ".%03d",
                static_cast<int>(at.st_mtim.tv_nsec / 1000000));
  return std::to_string(at.st_size) + " bytes of " + text + milliseconds + " UTC";
}

std::string short_hash(const Hasher& hasher) { return hasher.hash().text().substr(0, 12); }

}  // namespace

const Facts& StepRun::facts() {
  if (!facts_.empty()) return facts_;
  const StepDescription& step = *plan_.description;
  Facts facts = {{"step", step.name}, {"version of " + step.name, std::to_string(step.version)}};
  if (!step.across_builds && !step.build.empty())
    facts.push_back({"the build of " + step.name, step.build.substr(0, 12)});
  for (const ParameterDescription& parameter : step.parameters) {
    const auto at = values_.find(parameter.name);
    if (at == values_.end() || !parameter.affects_result) continue;
    facts.push_back({parameter.name, written(parameter, at->second)});
    const auto* path = std::get_if<std::string>(&at->second);
    if (parameter.kind == ParameterKind::path && path && !path->empty())
      facts.push_back({"what lies at '" + parameter.name + "'", size_and_time(*path)});
  }
  for (std::size_t p = 0; p < inputs_.size(); ++p) {
    Hasher hasher;
    const std::size_t calls = itemwise() ? items() : 1;
    for (std::size_t k = 0; k < calls; ++k) hash_input(hasher, p, k);
    std::string from;
    for (const Source& source : inputs_[p])
      from += (from.empty() ? "" : ", ") + source.run->plan().path;
    if (!from.empty())
      facts.push_back(
          {"input '" + step.inputs[p].name + "'", short_hash(hasher) + " (" + from + ")"});
  }
  return facts_ = std::move(facts);
}

}  // namespace plumb
