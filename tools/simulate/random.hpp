#pragma once
/// Random numbers that depend on nothing but their seed: no standard distribution, whose output
/// differs by library.

#include <cstdint>

namespace plumb::simulate {

/// Mixes 64 bits so that every input bit moves every output bit. Source: SplitMix64's finaliser
/// (Steele et al. 2014).
inline std::uint64_t mix(std::uint64_t v) {
  v += 0x9e3779b97f4a7c15ULL;
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ULL;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebULL;
  return v ^ (v >> 31);
}

/// A number that belongs to the counters (a, b, c), in whatever order they are asked for.
inline std::uint64_t mix(std::uint64_t a, std::uint64_t b, std::uint64_t c = 0) {
  return mix(mix(mix(a) ^ b) ^ c);
}

/// Uniform in [0, 1) from 24 of the bits; exact on every machine.
inline float unit(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

/// Nearly normal, mean 0 and deviation 1: the sum of four uniform numbers, exact on every machine,
/// never beyond 3.47.
inline float normal(std::uint64_t bits) {
  const auto part = [bits](int k) {
    return static_cast<std::int32_t>((bits >> (16 * k)) & 0xffff);
  };
  const std::int32_t sum = part(0) + part(1) + part(2) + part(3) - 2 * 0xffff;
  return static_cast<float>(sum) * (1.7320508f / 65536.0f);
}

/// A sequence of numbers for what is laid out once, in order.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() { return mix(state_++); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }
  bool chance(double share) { return uniform(0, 1) < share; }
  double gauss() { return static_cast<double>(normal(next())); }

 private:
  std::uint64_t state_;
};

}  // namespace plumb::simulate
