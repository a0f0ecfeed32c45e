#pragma once
/// What a step may ask of the engine while it runs. No step starts a thread, reads a clock or prints.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace plumb {

class Context {
 public:
  virtual ~Context() = default;

  /// Adds `n` to a count that is summed over all items and said at the end: count("points without a number dropped", 12).
  virtual void count(std::string_view what, std::uint64_t n) = 0;

  /// Says one sentence to the user; the run goes on.
  virtual void warn(const std::string& sentence) = 0;

  /// Seed for anything random: it depends on the item's inputs and parameters alone.
  virtual std::uint64_t seed() const = 0;

  /// Calls body(k) for k = 0 .. n-1 on the engine's threads, in any order, and waits. An exception of the smallest k is rethrown.
  /// The result must not depend on the order: write to slot k.
  virtual void parallel(std::size_t n, const std::function<void(std::size_t)>& body) = 0;
};

/// A small counter-based generator (splitmix64): the same numbers on every machine, for every seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  /// Uniform in 0 .. n-1; n at least 1.
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((next() >> 32) * n) >> 32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace plumb
