#pragma once
/// Which results of a store the runs in progress made or used, so that none of them removes what
/// another one needs.

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <unordered_set>

#include "plumb/data/hash.hpp"

namespace plumb {

using KeySet = std::unordered_set<Hash128, Hash128Hash>;
class HeldElsewhere;

/// Those of this run. Other processes find them in a file, DIR/runs/TOKEN, 16 bytes a key, as soon
/// as they are added. It is locked (flock) for as long as its run lives: one that nobody locks is
/// of a run that was killed, and the next run removes it. Where the disk does not take it others do
/// not know what this run needs; what they remove is made again. Safe from several threads.
class Holds {
 public:
  Holds(const std::filesystem::path& store, const std::string& token);
  ~Holds();  ///< lets go of all
  Holds(const Holds&) = delete;
  Holds& operator=(const Holds&) = delete;

  /// Asked before a result is opened or written.
  void add(std::span<const Hash128> keys);
  bool has(const Hash128& key) const;
  /// Those of all other runs.
  HeldElsewhere elsewhere() const;
  /// Does what follows when this run does not need a result; until it is done no key is added.
  /// False when the run needs it.
  bool unless_held(const Hash128& key, const std::function<void()>& action) const;
  std::filesystem::path file() const;

 private:
  void begin();
  void tell(std::span<const Hash128> keys);

  std::filesystem::path folder_, file_;
  std::string token_;
  mutable std::mutex mutex_;
  KeySet keys_;
  int to_ = -1;                        ///< the file, from the first key on
  bool begun_ = false, whole_ = true;  ///< whole: the file holds all keys
};

/// Those of all runs but one.
class HeldElsewhere {
 public:
  /// Of all that have a file beside `own`, in `folder`.
  HeldElsewhere(std::filesystem::path folder, std::filesystem::path own);
  ~HeldElsewhere();
  HeldElsewhere(const HeldElsewhere&) = delete;
  HeldElsewhere& operator=(const HeldElsewhere&) = delete;

  /// Whether a run holds the key. Before this is denied, what runs added meanwhile is read; a run
  /// that cannot say what it needs holds everything.
  bool has(const Hash128& key);

 private:
  void look();
  void take(const std::filesystem::path& file);
  bool read_on(int file);

  std::filesystem::path folder_, own_;
  std::map<std::string, int> files_;  ///< by name; of runs in progress, read up to here
  KeySet keys_;
  bool unsure_ = false;
};

}  // namespace plumb
