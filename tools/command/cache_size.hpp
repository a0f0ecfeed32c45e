#pragma once
/// How much the cache may hold: `--cache-size AMOUNT`, else PLUMB_CACHE_SIZE, else what is chosen
/// for its disk.

#include <cstdint>
#include <optional>
#include <string>

#include "plumb/store/size_bound.hpp"
#include "store_option.hpp"

namespace plumb::command {

/// What runs keep a cache below.
struct CacheLimit {
  std::optional<std::uint64_t> bytes;  ///< none: it may grow
  std::string text = "none", why = {};
  bool of_disk = false;  ///< it is the disk that allows no more

  /// "5GB (--cache-size)", "20 GB (the default)".
  std::string shown() const { return text + " (" + why + ")"; }
};

struct CacheSize {
  std::string given = {};  ///< by --cache-size

  void add_to(Command& command);
  /// Throws UsageError for what is no amount, and where there is no cache to be bounded.
  void require_one_meaning(const StoreOption& store) const;
  CacheLimit limit(Store& store) const;
};

/// The cache of the runs that a command makes, and its bound.
class BoundedCache {
 public:
  BoundedCache(const CacheSize& size, Store* store)  ///< none: nothing is bounded
      : limit_(store ? size.limit(*store) : CacheLimit()), bound_(store, limit_.bytes) {}

  SizeBound* bound() { return &bound_; }
  /// After the last run. Says on standard error what was removed, unless `quiet`, and warns when
  /// what the runs need alone is more than the cache may hold.
  void end(bool quiet);

 private:
  CacheLimit limit_;
  SizeBound bound_;
};

}  // namespace plumb::command
