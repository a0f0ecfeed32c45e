#pragma once
/// Random numbers that are the same everywhere.

#include <cstdint>

namespace plumb {

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

/// Another seed for each `number`; for 0 the same, so that a parameter whose default is 0 changes
/// nothing until it is set.
inline std::uint64_t reseeded(std::uint64_t seed, std::uint64_t number) {
  return number == 0 ? seed : seed ^ Random(number).next();
}

}  // namespace plumb
