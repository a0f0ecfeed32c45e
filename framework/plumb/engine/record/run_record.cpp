/// What a run depends on, seen now and compared with what a record says.
#include "plumb/engine/record/run_record.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <map>
#include <set>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb {
namespace {

std::string hash_of_this_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&abi_tag), &info) && info.dli_fname)
    return file_hash(info.dli_fname).text();
  return "";
}

/// Hashes each module once.
class Modules {
 public:
  std::string hash(const std::string& file) {
    if (file.empty()) return "";
    const auto [at, is_new] = hashes_.try_emplace(file);
    if (is_new) at->second = file_hash(file).text();
    return at->second;
  }

 private:
  std::map<std::string, std::string> hashes_;
};

RunRecord record_of_plumb() {
  RunRecord record;
  record.plumb = PLUMB_VERSION;
  record.abi = abi_tag();
  record.library = hash_of_this_library();
  return record;
}

std::string were(const std::string& then, const std::string& now) {
  return " was " + then + ", is " + now;
}

std::string difference_of(const StepRecord& then, const StepRecord& now) {
  const std::string step = "step '" + then.path + "' (" + then.use + ")";
  if (now.version == 0)
    return step + " was version " + std::to_string(then.version) +
           ", is not installed; install its module";
  if (then.version != now.version)
    return step +
           were("version " + std::to_string(then.version),
                "version " + std::to_string(now.version)) +
           "; install the module of then";
  if (then.module != now.module)
    return "the module of " + step + were(then.module, now.module) + "; install the module of then";
  return "";
}

std::string difference_of(const InputRecord& then, const InputRecord& now) {
  const std::string input = "the input '" + then.path + "'", cure = "; put back what was there";
  if (then.files > 0 && now.files == 0)
    return input + were(counted(then.files, "files"), "gone") + cure;
  if (then.files != now.files)
    return input + were(counted(then.files, "files"), std::to_string(now.files)) + cure;
  if (then.bytes != now.bytes)
    return input + were(counted(then.bytes, "bytes"), std::to_string(now.bytes)) + cure;
  if (then.content)
    return then.content == now.content
               ? ""
               : "the content of " + input + were(then.content->text(), now.content->text()) + cure;
  if (then.digest == now.digest) return "";
  return "the names, sizes and times of " + input + were(then.digest.text(), now.digest.text()) +
         "; put back what was there, or record runs with --verify-inputs, which goes by content "
         "where files are copied";
}

}  // namespace

RunRecord record_of(const Plan& plan, bool content) {
  RunRecord record = record_of_plumb();
  record.name = plan.name;
  record.pipeline = plan.resolved;
  Modules modules;
  for (const PlannedStep& step : plan.steps)
    record.steps.push_back({step.path, step.description->name, step.description->version,
                            modules.hash(step.description->module)});
  for (const std::string& path : input_paths(plan))
    record.inputs.push_back(input_record(path, content));
  return record;
}

bool describes(const RunRecord& record, const Plan& plan) {
  std::vector<std::string> paths;
  for (const InputRecord& input : record.inputs) paths.push_back(input.path);
  return paths == input_paths(plan) &&
         std::equal(plan.steps.begin(), plan.steps.end(), record.steps.begin(), record.steps.end(),
                    [](const PlannedStep& planned, const StepRecord& step) {
                      return planned.path == step.path && planned.description->name == step.use &&
                             planned.description->version == step.version;
                    });
}

RunRecord record_now(const RunRecord& then, const Registry& registry, bool content) {
  RunRecord now = record_of_plumb();
  now.name = then.name;
  now.pipeline = then.pipeline;
  Modules modules;
  for (const StepRecord& step : then.steps) {
    const StepDescription* found = registry.find(step.use);
    now.steps.push_back(
        found ? StepRecord{step.path, step.use, found->version, modules.hash(found->module)}
              : StepRecord{step.path, step.use, 0, ""});
  }
  for (const InputRecord& input : then.inputs)
    now.inputs.push_back(input_record(input.path, content || input.content));
  return now;
}

std::string changed_input(const RunRecord& record) {
  for (const InputRecord& then : record.inputs)
    if (const InputRecord now = input_record(then.path, then.content.has_value());
        !difference_of(then, now).empty())
      return "the input '" + then.path + "' was changed while it was read";
  return "";
}

std::vector<std::string> differences(const RunRecord& then, const RunRecord& now) {
  std::vector<std::string> found;
  if (then.plumb != now.plumb)
    found.push_back("plumb" + were("version " + then.plumb, "version " + now.plumb) +
                    "; use the version of then");
  if (then.abi != now.abi)
    found.push_back("the ABI" + were("'" + then.abi + "'", "'" + now.abi + "'") +
                    "; use the build of then");
  if (then.library != now.library)
    found.push_back("libplumb" + were(then.library, now.library) + "; use the build of then");
  std::set<std::string> told;  // a module that several steps use is told of once
  for (std::size_t k = 0; k < then.steps.size(); ++k)
    if (std::string sentence = difference_of(then.steps[k], now.steps[k]);
        !sentence.empty() && told.insert(then.steps[k].use).second)
      found.push_back(std::move(sentence));
  for (std::size_t k = 0; k < then.inputs.size(); ++k)
    if (std::string sentence = difference_of(then.inputs[k], now.inputs[k]); !sentence.empty())
      found.push_back(std::move(sentence));
  return found;
}

}  // namespace plumb
