#include "plumb/plugin/registry.hpp"

#include <dlfcn.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/plugin/manifest.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

/// Why a folder may not be searched; empty if it may.
std::string fault_of_folder(const fs::path& folder) {
  struct stat info {};
  if (stat(folder.c_str(), &info) != 0) return "there is no such folder";
  if (!S_ISDIR(info.st_mode)) return "is no folder";
  if (info.st_mode & S_IWOTH)
    return "others may write into it, so anyone could put code there; `chmod o-w` it";
  return "";
}

fs::path folder_of_this_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&abi_tag), &info) && info.dli_fname)
    return fs::weakly_canonical(info.dli_fname).parent_path();
  return {};
}

}  // namespace

std::vector<fs::path> Registry::shipped_folders() { return {folder_of_this_library() / "plumb"}; }

std::vector<fs::path> Registry::standard_folders(const std::vector<fs::path>& extra) {
  std::vector<fs::path> folders = shipped_folders();
  folders.insert(folders.end(), extra.begin(), extra.end());
  if (const char* variable = std::getenv("PLUMB_PLUGIN_PATH")) {
    std::istringstream list(variable);
    for (std::string entry; std::getline(list, entry, ':');)
      if (!entry.empty()) folders.push_back(fs::absolute(entry));
  }
  return folders;
}

Registry Registry::scan(const std::vector<fs::path>& folders) {
  Registry registry;
  registry.folders_ = folders;
  for (const fs::path& folder : folders) {
    if (const std::string fault = fault_of_folder(folder); !fault.empty()) {
      registry.refused_.push_back({folder, fault});
      continue;
    }
    std::vector<fs::path> modules;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".so") modules.push_back(entry.path());
    std::sort(modules.begin(), modules.end());
    for (const fs::path& module : modules) {
      const fs::path file = fs::path(module).replace_extension(".json");
      if (!fs::exists(file)) {
        registry.refused_.push_back({module, "has no manifest beside it; `plumb_manifest` makes one, the build runs it"});
        continue;
      }
      try {
        constexpr std::uint64_t most = std::uint64_t{4} << 20;
        Manifest manifest = read_manifest(std::string(io::FileBytes(file, most, "manifest").view()), file.string());
        if (manifest.abi_tag != abi_tag())
          throw Error("was built for another Plumb: it has '" + manifest.abi_tag + "', this one has '" +
                      abi_tag() + "'; build the module again with this SDK");
        for (StepDescription& step : manifest.steps) {
          step.module = module.string();
          const auto [at, is_new] = registry.entries_.try_emplace(step.name);
          if (is_new) at->second.description = std::move(step);
          else
            registry.refused_.push_back({module, "step " + at->first + " was already found in " +
                                                     at->second.description.module});
        }
      } catch (const std::exception& e) {
        registry.refused_.push_back({module, e.what()});
      }
    }
  }
  return registry;
}

void Registry::add(const Step& step) {
  entries_[step.description().name] = {step.description(), &step};
}

const StepDescription* Registry::find(std::string_view name) const {
  const auto at = entries_.find(name);
  return at == entries_.end() ? nullptr : &at->second.description;
}

std::vector<const StepDescription*> Registry::all() const {
  std::vector<const StepDescription*> list;
  for (const auto& [name, entry] : entries_) list.push_back(&entry.description);
  return list;
}

const Step& Registry::step(const std::string& name) const {
  const auto at = entries_.find(name);
  if (at == entries_.end()) throw Error("there is no step '" + name + "'");
  if (at->second.step) return *at->second.step;
  const std::string& file = at->second.description.module;
  for (const Step* step : load_module(file)) {
    if (step->description().name != name) continue;
    if (step_json(step->description()) != step_json(at->second.description))
      throw Error(file + ": declares " + name + " otherwise than its manifest says; build the module again");
    return *step;
  }
  throw Error(file + ": does not hold the step " + name + " that its manifest names; build the module again");
}

}  // namespace plumb
