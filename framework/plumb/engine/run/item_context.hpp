#pragma once
/// The Context that a step sees while it makes one item.

#include <atomic>
#include <optional>

#include "plumb/engine/observe/bookkeeping.hpp"
#include "plumb/plugin/context.hpp"
#include "plumb/store/store.hpp"

namespace plumb {

/// Measures the CPU time of this thread from construction to destruction and books it for a step.
/// Stopwatches nest: the time of an inner one is not the outer one's.
class Stopwatch {
 public:
  /// With `sum` [ns] the time is added there and not booked.
  Stopwatch(Bookkeeping& books, const std::string& path, std::atomic<std::int64_t>* sum = nullptr);
  ~Stopwatch();
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  /// Says that what the innermost stopwatch of this thread measures is an item: it is told of when
  /// that stopwatch ends.
  static void item(std::string name, int pass, bool reused);
  /// Adds what other stopwatches summed up to the innermost of this thread.
  static void add(std::int64_t nanoseconds);
  /// Of the step that this thread works for; null for none.
  static const std::string* path();

 private:
  struct Item {
    std::string name;
    int pass;
    bool reused;
  };
  Bookkeeping& books_;
  const std::string& path_;
  std::atomic<std::int64_t>* sum_;
  Stopwatch* outer_;
  Bookkeeping::Clock::time_point begin_;
  std::int64_t cpu_begin_, inner_ = 0, added_ = 0;  ///< [ns]
  std::optional<Item> item_;
};

class ItemContext final : public Context {
 public:
  /// With `counts` false what the step counts is not heard: the item was made before, and its
  /// counts are booked. `seed` is asked when the step does. What the step says is written down in
  /// `said` too, if that is given.
  ItemContext(Bookkeeping& books, const std::string& path, std::function<std::uint64_t()> seed,
              bool counts = true, StoredResult* said = nullptr)
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
