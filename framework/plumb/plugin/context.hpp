#pragma once
/// What a step may ask of the engine while it runs. No step starts a thread, reads a clock or
/// prints.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "plumb/data/random.hpp"

namespace plumb {

class Context {
 public:
  virtual ~Context() = default;

  /// Adds `n` to a count that is summed over all items and said at the end: count("points without a
  /// number dropped", 12).
  virtual void count(std::string_view what, std::uint64_t n) = 0;

  /// Says one sentence to the user; the run goes on.
  virtual void warn(const std::string& sentence) = 0;

  /// Seed for anything random: it depends on the item's inputs and parameters alone.
  virtual std::uint64_t seed() const = 0;

  /// Calls body(k) for k = 0 .. n-1 on the engine's threads, in any order, and waits. An exception
  /// of the smallest k is rethrown. The result must not depend on the order: write to slot k.
  virtual void parallel(std::size_t n, const std::function<void(std::size_t)>& body) = 0;
};

}  // namespace plumb
