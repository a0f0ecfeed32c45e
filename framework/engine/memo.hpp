#pragma once
/// Results remembered within a run under their keys, so that what does not change between passes is made once.

#include <list>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "plumb/data/type.hpp"

namespace plumb {

/// Keeps the most recently used results up to a number of bytes. Safe from several threads.
class Memo {
 public:
  explicit Memo(std::size_t budget) : budget_(budget) {}

  /// The outputs stored under `key`, if they are still here.
  std::optional<std::vector<AnyValue>> find(const Hash128& key);
  void store(const Hash128& key, std::vector<AnyValue> outputs);

 private:
  struct Entry {
    Hash128 key;
    std::vector<AnyValue> outputs;
    std::size_t bytes;
  };
  std::mutex mutex_;
  std::size_t budget_, bytes_ = 0;
  std::list<Entry> entries_;  // most recently used first
  std::unordered_map<Hash128, std::list<Entry>::iterator, Hash128Hash> index_;
};

}  // namespace plumb
