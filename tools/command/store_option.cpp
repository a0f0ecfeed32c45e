#include "store_option.hpp"

#include <cstdlib>
#include <iostream>

#include "command_line.hpp"
#include "plumb/data/error.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace fs = std::filesystem;

fs::path user_cache_folder() {
  const auto absolute = [](const char* name) {
    const char* value = std::getenv(name);
    const fs::path path = value ? value : "";
    return path.is_absolute() ? path : fs::path();  // a relative one is to be ignored, says the XDG
                                                    // base directory specification
  };
  if (const fs::path cache = absolute("XDG_CACHE_HOME"); !cache.empty()) return cache / "plumb";
  if (const fs::path home = absolute("HOME"); !home.empty()) return home / ".cache" / "plumb";
  return {};
}

void StoreOption::add_to(Command& command) {
  const std::string without = !otherwise_of.empty() ? otherwise_of
                              : otherwise.empty() ? "PLUMB_CACHE_DIR, or the user's cache folder, "
                                                    "~/.cache/plumb"
                                                  : otherwise;
  command.add_option("--cache-dir", given,
                     "Folder in which results are kept, and from which a later run takes what did "
                     "not change; `none` keeps nothing. Without: " +
                         without);
  command.add_option("--store", former, "Former name of --cache-dir").group("");
  command.add_flag("--trust-cache", trusted,
                   "Use the cache even where others own it or may write it: whoever can, decides "
                   "over the results");
  command.add_flag("--trust-store", trusted, "Former name of --trust-cache").group("");
}

void StoreOption::add_usage_to(Command& command) {
  command.add_flag("--refresh", refresh, "Make all results anew, and keep them in the cache");
  command.add_flag("--fresh", refresh, "Former name of --refresh").group("");
  command.add_flag("--no-cache", no_cache, "Take nothing from the cache and keep nothing in it");
}

void StoreOption::require_one_meaning() const {
  if (!given.empty() && !former.empty())
    throw UsageError("--store " + former +
                     ": is the former name of --cache-dir, which is given too; leave it out");
  if (no_cache && refresh)
    throw UsageError(
        "--no-cache: keeps nothing, and --refresh makes all anew to keep it; leave one of them "
        "out");
  const std::string& folder = given.empty() ? former : given;
  const std::string option = (given.empty() ? "--store " : "--cache-dir ") + folder;
  if (no_cache && !folder.empty() && folder != "none")
    throw UsageError(option + ": is not used with --no-cache; leave one of them out");
  if (refresh && folder == "none")
    throw UsageError("--refresh: makes all anew to keep it, and " + option +
                     " keeps nothing; leave one of them out");
}

StoreOption::Meant StoreOption::meant() const {
  if (no_cache) return {"none", "--no-cache"};
  if (!given.empty()) return {given, "--cache-dir " + given};
  if (!former.empty()) return {former, "--store " + former};
  if (!otherwise.empty()) return {otherwise, ""};
  for (const char* name : {"PLUMB_CACHE_DIR", "PLUMB_STORE"})
    if (const char* value = std::getenv(name); value && *value)
      return {value, std::string(name) + "=" + value};
  return {};
}

fs::path StoreOption::folder() const {
  const std::string said = meant().folder;
  return said == "none" ? fs::path() : said.empty() ? user_cache_folder() : fs::path(said);
}

std::string StoreOption::title() const {
  const std::string by = meant().by;
  return by.empty() ? "the cache " + folder().string() : by;
}

std::unique_ptr<Store> StoreOption::open(const fs::path& at) const {
  return std::make_unique<Store>(at, StoreRole::driver, trusted ? Whose::anyones : Whose::own,
                                 title());
}

std::unique_ptr<Store> StoreOption::open() const {
  if (none()) return nullptr;
  if (!meant().folder.empty()) return open(folder());
  const auto go_without = [](const std::string& why) {
    std::cerr << "cache: nothing is kept, " << why
              << "; say where by --cache-dir DIR, or say --no-cache\n";
    return nullptr;
  };
  if (folder().empty()) return go_without("for neither XDG_CACHE_HOME nor HOME names a folder");
  try {
    return open(folder());
  } catch (const Error& e) {
    return go_without("for the user's cache folder cannot be used (" + std::string(e.what()) + ")");
  }
}

void say_faults(const Store& store) {
  if (store.damaged())
    std::cerr << "cache: " << store.damaged() << " damaged result"
              << (store.damaged() == 1 ? " was" : "s were") << " removed and made again ("
              << (store.damaged() == 1 ? "" : "the first: ") << store.damage() << ")\n";
  if (const std::string why = store.index_rebuilt(); !why.empty())
    std::cerr << "cache: its index was damaged (" << why
              << ") and has been made anew from the results\n";
  if (const std::string fault = store.fault(); !fault.empty())
    std::cerr << "cache: from some result on nothing was kept in " << store.folder().string()
              << " (" << fault
              << "); the run and what is kept already are whole; make room (plumb cache prune), or "
                 "name another folder with --cache-dir\n";
  else if (const std::string index = store.index_fault(); !index.empty())
    std::cerr << "cache: its index is not used (" << index
              << "); results are kept and found without it\n";
}

}  // namespace plumb::command
