#pragma once
/// Results of calls under their keys: those asked for last in memory, all of them in the store if
/// there is one.

#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>

#include "plumb/store/store.hpp"

namespace plumb {

/// What one call gave, shared and immutable.
using SharedResult = std::shared_ptr<const StoredResult>;

/// About how much memory a result holds [bytes], search trees that will be built on its clouds
/// included.
std::size_t memory_of(const StoredResult& result);

/// Keys that were noted during a run. Safe from several threads.
class NotedKeys {
 public:
  bool note(const Hash128& key);  ///< false when it was noted before
  bool has(const Hash128& key) const;

 private:
  mutable std::mutex mutex_;
  std::unordered_set<Hash128, Hash128Hash> keys_;
};

/// Keeps the most recently used results up to a number of bytes in memory. What the store took may
/// leave memory and come back; the rest must be held by whoever needs it. Safe from several
/// threads.
class Results {
 public:
  /// With `fresh` nothing that an earlier run left in the store is found. With `frugal` only what
  /// was asked for stays in memory, not what was just made and is in the store.
  Results(Store* store, bool fresh, std::size_t budget, bool frugal = false)
      : store_(store), fresh_(fresh), frugal_(frugal), budget_(budget) {}

  /// The result under `key`, from memory or from the store; null when it is in neither. One in the
  /// store that has a fault is removed from there.
  SharedResult find(const Hash128& key, const FaultOf& fault_of = nullptr);
  /// As find, from memory alone.
  SharedResult remembered(const Hash128& key);
  /// Keeps what the step called `step` made.
  SharedResult keep(const Hash128& key, StoredResult result, const std::string& step);
  /// Keeps it in memory only.
  SharedResult remember(const Hash128& key, StoredResult result);
  /// Another process put `key` into the store.
  void made_elsewhere(const Hash128& key, const std::string& step);
  /// Whether the result can come back from the store, so that nobody need hold it.
  bool in_store(const Hash128& key) const;
  /// Memory that a result takes, about: of one that was not seen in this run the size of its file.
  std::size_t size_of(const Hash128& key) const;

  /// Results, and steps that were recalled, of which this run has said what they counted.
  NotedKeys& said() { return said_; }
  /// Where steps of this run found nothing to recall (engine/run/step_recall.cpp).
  NotedKeys& unknown() { return unknown_; }

  Store* store() const { return store_; }
  bool fresh() const { return fresh_; }

 private:
  struct Entry {
    Hash128 key;
    SharedResult result;
    std::size_t bytes;
  };
  struct Fact {
    std::size_t bytes = 0;
    bool in_store = false;
  };
  void insert(const Hash128& key, const SharedResult& result, bool in_store, bool stays = true);

  Store* store_;
  bool fresh_, frugal_;
  mutable std::mutex mutex_;
  std::size_t budget_, bytes_ = 0;
  std::list<Entry> entries_;  // most recently used first
  std::unordered_map<Hash128, std::list<Entry>::iterator, Hash128Hash> index_;
  std::unordered_map<Hash128, Fact, Hash128Hash>
      facts_;  // of every result that this run made or found
  NotedKeys said_, unknown_;
};

}  // namespace plumb
