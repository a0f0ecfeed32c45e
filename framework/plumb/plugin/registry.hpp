#pragma once
/// Which steps there are, read from manifests without running any module; and the modules, loaded
/// when a step is needed.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "plumb/plugin/left_out.hpp"
#include "plumb/plugin/licence.hpp"
#include "plumb/plugin/step.hpp"

namespace plumb {

/// What was found at one place and not taken, and why.
struct Refusal {
  std::filesystem::path file;
  std::string why;
};

/// Modules are looked for in the build's or installation's own folder, then in each
/// `--plugin-path`, then in PLUMB_PLUGIN_PATH; never in the working folder by itself. Neither
/// folders nor files are taken that others may have written (trusted_file.hpp). The first to offer
/// a step has it.
class Registry {
 public:
  /// Reads all manifests (*.json beside the modules) of `folders`.
  static Registry scan(const std::vector<std::filesystem::path>& folders);
  /// Where the modules are that Plumb came with: beside libplumb.
  static std::vector<std::filesystem::path> shipped_folders();
  /// The standard folders: the shipped ones, then `extra`, then the environment's.
  static std::vector<std::filesystem::path> standard_folders(
      const std::vector<std::filesystem::path>& extra);
  /// Takes steps that live in this process (tests).
  void add(const Step& step);

  const StepDescription* find(std::string_view name) const;
  std::vector<const StepDescription*> all() const;  ///< by name
  /// Of the module that a step comes from, by its manifest.
  const Licence& licence_of(const StepDescription& step) const;
  const std::vector<Refusal>& refused() const { return refused_; }
  /// What the builds of these folders left out and no module of them offers.
  const StepsLeftOut& left_out() const { return left_out_; }
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

  /// The step itself; loads its module. Throws Error when it cannot be loaded, has another ABI
  /// (naming both), or does not declare what its manifest says.
  const Step& step(const std::string& name) const;

 private:
  void take(const std::filesystem::path& module);
  struct Entry {
    StepDescription description;
    const Step* step = nullptr;  // of add()
  };
  std::map<std::string, Entry, std::less<>> entries_;
  std::map<std::string, Licence> licences_;  // by module
  std::vector<Refusal> refused_;
  StepsLeftOut left_out_;
  std::vector<std::filesystem::path> folders_;
};

/// Loads a module for good (dlopen, never closed) and returns its steps. Throws Error naming the
/// file and what does not fit, and, before any of its code runs, when others may have written it.
std::vector<const Step*> load_module(const std::filesystem::path& file);

/// This library's own ABI tag.
const char* abi_tag();

}  // namespace plumb
