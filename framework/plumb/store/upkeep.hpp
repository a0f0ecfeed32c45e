#pragma once
/// Looking after a store: whether what it holds is whole, and how it is kept small. Safe while runs
/// use it.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "plumb/store/store.hpp"

namespace plumb {

/// What verify found.
struct Verified {
  std::size_t results = 0;           ///< looked at
  std::uint64_t bytes = 0;           ///< of them
  std::vector<std::string> damaged;  ///< keys of those that were not whole, and are removed now;
                                     ///< "describe.fpfh 4f0c...e1" where the step is known
  bool good(const Store& store) const { return damaged.empty() && store.index_rebuilt().empty(); }
};

/// Checks the checksum of every result and every row of the index, and removes what is damaged.
Verified verify(Store& store);

/// What may stay.
struct PruneLimits {
  std::optional<std::chrono::milliseconds> older;  ///< what was used within this time
  std::optional<std::uint64_t> bytes;              ///< this much, of what was used last
};

/// What prune removed, and what is left.
struct Pruned {
  std::size_t results = 0, left = 0;
  std::size_t held = 0;        ///< of those that are left: what only a run in progress keeps there
  std::size_t unfinished = 0;  ///< files of runs that were killed while they wrote them
  std::uint64_t bytes = 0, left_bytes = 0, unfinished_bytes = 0;
};

/// Removes results, least recently used first, until the limits hold, but none that another run in
/// progress made or used (holds.hpp); and what was begun in DIR/new more than a day ago. Throws
/// Error when the index, which knows what was used when, cannot be read.
Pruned prune(Store& store, const PruneLimits& limits);

}  // namespace plumb
