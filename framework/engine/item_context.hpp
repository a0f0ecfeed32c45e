#pragma once
/// The Context that a step sees while it makes one item.

#include "plumb/engine/bookkeeping.hpp"
#include "plumb/plugin/context.hpp"

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
  ItemContext(Bookkeeping& books, const std::string& path, std::uint64_t seed)
      : books_(books), path_(path), seed_(seed) {}
  void count(std::string_view what, std::uint64_t n) override { books_.count(path_, what, n); }
  void warn(const std::string& sentence) override { books_.warn(path_, sentence); }
  std::uint64_t seed() const override { return seed_; }
  void parallel(std::size_t n, const std::function<void(std::size_t)>& body) override;

 private:
  Bookkeeping& books_;
  const std::string& path_;
  std::uint64_t seed_;
};

}  // namespace plumb
