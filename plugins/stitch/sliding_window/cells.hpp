#pragma once
/// A cloud thinned while it grows: the mean of the points in each cell.

#include <cmath>
#include <cstdint>
#include <vector>

#include "plumb/data/cloud.hpp"

namespace plumb {

/// Adds points to their cells floor(p / leaf); the cells come out in the order in which they were first met. For groups of
/// some thousand points: a table with open addressing that stays in the cache. Points must lie within 2^20 cells of the origin.
class Cells {
 public:
  explicit Cells(double leaf) : per_leaf_(static_cast<float>(1 / leaf)), slots_(1 << 10) {}

  void add(float x, float y, float z) {
    if (2 * sums_.size() >= slots_.size()) grow();
    const std::uint64_t key = part(x) | part(y) << 21 | part(z) << 42;
    Slot& slot = find(key);
    if (slot.cell == none) {
      slot = {key, static_cast<std::uint32_t>(sums_.size())};
      sums_.push_back({x, y, z, 1});
      return;
    }
    Sum& sum = sums_[slot.cell];
    sum.x += x, sum.y += y, sum.z += z, sum.n += 1;
  }

  Cloud cloud() const {
    Cloud cloud;
    cloud.reserve(sums_.size());
    for (const Sum& s : sums_)
      cloud.add({static_cast<float>(s.x / s.n), static_cast<float>(s.y / s.n), static_cast<float>(s.z / s.n)});
    return cloud;
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t cell = none;
  };
  struct Sum {
    double x, y, z, n;
  };

  std::uint64_t part(float x) const {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x * per_leaf_)) + (1 << 20)) & 0x1fffff;
  }
  Slot& find(std::uint64_t key) {
    std::uint64_t at = key * 0x9e3779b97f4a7c15ull >> 20 & (slots_.size() - 1);
    while (slots_[at].cell != none && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  void grow() {
    std::vector<Slot> old(4 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.cell != none) find(slot.key) = slot;
  }

  float per_leaf_;
  std::vector<Slot> slots_;  ///< a power of two, at most half full
  std::vector<Sum> sums_;
};

}  // namespace plumb
