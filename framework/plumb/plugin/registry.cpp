#include "plumb/plugin/registry.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "plumb/data/error.hpp"
#include "plumb/data/hash.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/plugin/build_identity.hpp"
#include "plumb/plugin/manifest.hpp"
#include "plumb/plugin/trusted_file.hpp"

namespace plumb {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t largest_manifest = std::uint64_t{16} << 20;

/// The modules of a folder, by name.
std::vector<fs::path> modules_in(const fs::path& folder) {
  std::vector<fs::path> modules;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".so") modules.push_back(entry->path());
  if (error) throw Error("cannot be searched (" + error.message() + ")");
  std::sort(modules.begin(), modules.end());
  return modules;
}

/// What a module declares. Throws Error: it, or its manifest, is none that may be used.
Manifest manifest_of(const fs::path& module) {
  if (const std::string fault = fault_of_file(module); !fault.empty()) throw Error(fault);
  const fs::path file = fs::path(module).replace_extension(".json");
  if (!fs::exists(file))
    throw Error("has no manifest beside it; `plumb_manifest` makes one, the build runs it");
  if (const std::string fault = fault_of_file(file); !fault.empty())
    throw Error("its manifest " + file.string() + " " + fault);
  Manifest manifest = read_manifest(
      std::string(io::FileBytes(file, largest_manifest, "manifest").view()), file.string());
  if (manifest.abi_tag != abi_tag())
    throw Error("was built for another Plumb: it has '" + manifest.abi_tag + "', this one has '" +
                abi_tag() + "'; build the module again with this SDK");
  return manifest;
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
  for (const fs::path& folder : folders) try {
      if (const std::string fault = fault_of_folder(folder); !fault.empty()) throw Error(fault);
      for (const fs::path& module : modules_in(folder)) registry.take(module);
      registry.left_out_.merge(left_out_beside(folder));
    } catch (const Error& e) {
      registry.refused_.push_back({folder, e.what()});
    }
  std::erase_if(registry.left_out_,
                [&](const auto& step) { return registry.find(step.first) != nullptr; });
  return registry;
}

/// Takes the steps of a module, or writes down why not.
void Registry::take(const fs::path& module) {
  try {
    Manifest manifest = manifest_of(module);
    licences_[module.string()] = manifest.licence;
    Hasher build;
    build.text(build_of(module));
    build.text(build_of_libraries());
    for (StepDescription& step : manifest.steps) {
      step.module = module.string();
      step.build = build.hash().text();
      const auto [at, is_new] = entries_.try_emplace(step.name);
      if (is_new)
        at->second.description = std::move(step);
      else
        refused_.push_back({module, "step " + at->first + " was already found in " +
                                        at->second.description.module});
    }
  } catch (const std::exception& e) {
    refused_.push_back({module, e.what()});
  }
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

const Licence& Registry::licence_of(const StepDescription& step) const {
  static const Licence not_stated{};
  const auto at = licences_.find(step.module);
  return at == licences_.end() ? not_stated : at->second;
}

const Step& Registry::step(const std::string& name) const {
  const auto at = entries_.find(name);
  if (at == entries_.end()) throw Error("there is no step '" + name + "'");
  if (at->second.step) return *at->second.step;
  const std::string& file = at->second.description.module;
  for (const Step* step : load_module(file)) {
    if (step->description().name != name) continue;
    if (step_json(step->description()) != step_json(at->second.description))
      throw Error(file + ": declares " + name +
                  " otherwise than its manifest says; build the module again");
    return *step;
  }
  throw Error(file + ": does not hold the step " + name +
              " that its manifest names; build the module again");
}

}  // namespace plumb
