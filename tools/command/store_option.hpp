#pragma once
/// Where results are kept: `--store DIR`, else PLUMB_STORE, else the user's cache folder.

#include <filesystem>
#include <memory>
#include <string>

#include "plumb/store/store.hpp"

namespace CLI {
class App;
}

namespace plumb::command {

struct StoreOption {
  std::string given;     ///< a folder, "none", or "" for the user's cache folder
  bool trusted = false;  ///< also one that others own or may write

  void add_to(CLI::App& command);
  void add_trust_to(CLI::App& command);  ///< --trust-store alone
  bool none() const { return given == "none"; }
  /// The folder that is meant; empty for none, and where the user has no cache folder.
  std::filesystem::path folder() const;
  /// Opens it. None for `none`; and, with a note on standard error, where the user's cache folder
  /// cannot be used. Throws Error for a folder that was given.
  std::unique_ptr<Store> open() const;
  /// Opens this one. Throws Error.
  std::unique_ptr<Store> open(const std::filesystem::path& folder) const;
};

/// $XDG_CACHE_HOME/plumb or ~/.cache/plumb; empty where neither is known.
std::filesystem::path user_cache_folder();

/// One sentence each, on standard error: results that were damaged, an index that was, and what was
/// not kept.
void say_faults(const Store& store);

}  // namespace plumb::command
