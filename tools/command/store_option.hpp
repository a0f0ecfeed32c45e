#pragma once
/// The cache, where results are kept on disk: `--cache-dir DIR`, else PLUMB_CACHE_DIR, else the
/// user's cache folder; and how it is used.

#include <filesystem>
#include <memory>
#include <string>

#include "plumb/store/store.hpp"

namespace plumb::command {

class Command;  // command_line.hpp

struct StoreOption {
  std::string otherwise;  ///< what is meant when the command line says nothing; "" for what the
                          ///< environment says, or the user's cache folder
  std::string otherwise_of = {};        ///< the same for the help; "" for as `otherwise` has it
  std::string given = {}, former = {};  ///< by --cache-dir, and by --store, as it was called
  bool trusted = false;                 ///< also one that others own or may write
  bool refresh = false, no_cache = false;

  void add_to(Command& command);        ///< --cache-dir and --trust-cache
  void add_usage_to(Command& command);  ///< --refresh and --no-cache
  /// Throws UsageError for options that do not go together.
  void require_one_meaning() const;

  bool none() const { return meant().folder == "none"; }
  /// Whether an option says which.
  bool by_option() const { return !given.empty() || !former.empty(); }
  /// The folder that is meant; empty for none, and where the user has no cache folder.
  std::filesystem::path folder() const;
  /// What to change for another folder: "--cache-dir DIR", "PLUMB_CACHE_DIR=DIR"; "the cache DIR"
  /// when nothing was said.
  std::string title() const;
  /// Opens it. None for `none`; and, with a note on standard error, where the user's cache folder
  /// cannot be used. Throws Error for a folder that was given.
  std::unique_ptr<Store> open() const;
  /// Opens this one. Throws Error.
  std::unique_ptr<Store> open(const std::filesystem::path& folder) const;

 private:
  struct Meant {
    std::string folder;  ///< "none" for none, "" for the user's cache folder
    std::string by;      ///< what says so; "" when nothing does
  };
  Meant meant() const;
};

/// $XDG_CACHE_HOME/plumb or ~/.cache/plumb; empty where neither is known.
std::filesystem::path user_cache_folder();

/// One sentence each, on standard error: results that were damaged, an index that was, and what was
/// not kept.
void say_faults(const Store& store);

}  // namespace plumb::command
