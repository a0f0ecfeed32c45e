#pragma once
/// The Context that a step sees while it makes one item.

#include "plumb/engine/bookkeeping.hpp"
#include "plumb/plugin/context.hpp"
#include "plumb/store/store.hpp"

namespace plumb {

/// Measures the CPU time of this thread from construction to destruction and books it for a step. Stopwatches nest: the time of an
/// inner one is not the outer one's.
class Stopwatch {
 public:
  Stopwatch(Bookkeeping& books, const std::string& path);
  ~Stopwatch();
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Bookkeeping& books_;
  const std::string& path_;
  Stopwatch* outer_;
  double begin_, inner_ = 0;
};

class ItemContext final : public Context {
 public:
  /// With `counts` false what the step counts is not heard: the item was made before, and its counts are booked.
  /// `seed` is asked when the step does. What the step says is written down in `said` too, if that is given.
  ItemContext(Bookkeeping& books, const std::string& path, std::function<std::uint64_t()> seed, bool counts = true,
              StoredResult* said = nullptr)
      : books_(books), path_(path), seed_(std::move(seed)), counts_(counts), said_(said) {}
  void count(std::string_view what, std::uint64_t n) override;
  void warn(const std::string& sentence) override;
  std::uint64_t seed() const override { return seed_(); }
  void parallel(std::size_t n, const std::function<void(std::size_t)>& body) override;

 private:
  Bookkeeping& books_;
  const std::string& path_;
  std::function<std::uint64_t()> seed_;
  bool counts_;
  std::mutex mutex_;  ///< of said_
  StoredResult* said_;
};

}  // namespace plumb
