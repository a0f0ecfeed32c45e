#pragma once
/// How large a store may become: a bound that is chosen for its disk, and held while runs fill it.

#include <cstdint>
#include <optional>

#include "plumb/store/store.hpp"

namespace plumb {

/// The bound where nobody gives one [bytes].
inline constexpr std::uint64_t default_store_size = 20'000'000'000;

/// That, or four fifths of what the store's disk has for it (what the store holds, and what is free
/// there) if that is less: a fifth stays free for others.
std::uint64_t default_bound(Store& store);

/// What was removed so that a bound holds, and what is left.
struct Trimmed {
  std::size_t results = 0;       ///< removed
  std::uint64_t bytes = 0;       ///< of them
  std::uint64_t left_bytes = 0;  ///< of all that is left
  std::uint64_t own_bytes = 0;   ///< of that, what this run made or used; looked up when it is much

  void add(const Trimmed& later);
};

/// When a store holds more than `most`, removes results, least recently used first, until it holds
/// `bound` or less. Never those that a run in progress made or used: this one, by all that was
/// asked of `store`, also while this goes on, or others (holds.hpp). Sizes are those of the index;
/// no file is looked at but what is removed. Nothing is removed where the index cannot be used.
Trimmed trim(Store& store, std::uint64_t bound, std::uint64_t most);

/// Trims the store of a run while that fills it. Asked by one thread at a time.
class SizeBound {
 public:
  /// Without a store or a bound it does nothing.
  SizeBound(Store* store, std::optional<std::uint64_t> bytes);

  /// After a step: when the run has kept another eighth of the bound since the store was looked
  /// at, and a quarter more than the bound is there.
  void after_step();
  void at_end();  ///< of a run, or of several with one store
  const Trimmed& trimmed() const { return trimmed_; }

 private:
  void look(std::uint64_t most);

  Store* store_;
  std::uint64_t bytes_, looked_at_;  ///< looked_at_: what was kept by then
  Trimmed trimmed_;
};

}  // namespace plumb
