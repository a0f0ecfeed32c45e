#include "store_option.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>

#include "plumb/data/error.hpp"

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

void StoreOption::add_to(CLI::App& command) {
  command
      .add_option("--store", given,
                  "Folder in which results are kept, and from which a later run takes what did not "
                  "change; `none` keeps nothing. "
                  "Without: the user's cache folder, ~/.cache/plumb")
      ->envname("PLUMB_STORE");
  add_trust_to(command);
}

void StoreOption::add_trust_to(CLI::App& command) {
  command.add_flag("--trust-store", trusted,
                   "Use the store even where others own it or may write it: whoever can, decides "
                   "over the results");
}

fs::path StoreOption::folder() const {
  return none() ? fs::path() : given.empty() ? user_cache_folder() : fs::path(given);
}

std::unique_ptr<Store> StoreOption::open(const fs::path& at) const {
  return std::make_unique<Store>(at, StoreRole::driver, trusted ? Whose::anyones : Whose::own);
}

std::unique_ptr<Store> StoreOption::open() const {
  if (none()) return nullptr;
  if (!given.empty()) return open(given);
  const auto go_without = [](const std::string& why) {
    std::cerr << "store: nothing is kept, " << why
              << "; say where by --store DIR, or --store none\n";
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
    std::cerr << "store: " << store.damaged() << " damaged result"
              << (store.damaged() == 1 ? " was" : "s were") << " removed and made again ("
              << (store.damaged() == 1 ? "" : "the first: ") << store.damage() << ")\n";
  if (const std::string why = store.index_rebuilt(); !why.empty())
    std::cerr << "store: its index was damaged (" << why
              << ") and has been made anew from the results\n";
  if (const std::string fault = store.fault(); !fault.empty())
    std::cerr << "store: from some result on nothing was kept in " << store.folder().string()
              << " (" << fault
              << "); the run and what is kept already are whole; make room (plumb cache prune), or "
                 "name another folder with --store\n";
  else if (const std::string index = store.index_fault(); !index.empty())
    std::cerr << "store: its index is not used (" << index
              << "); results are kept and found without it\n";
}

}  // namespace plumb::command
