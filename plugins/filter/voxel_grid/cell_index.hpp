#pragma once
/// Numbers the occupied cells of a grid.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb {

/// Gives each cell key (not ~0) that it is asked for a number, 0, 1, 2 ... in the order of first
/// asking.
///
/// A hash table with open addressing. Most of its slots are far from the processor, so keys come in
/// batches: all their slots are fetched ahead, and the waits overlap.
class CellIndex {
 public:
  static constexpr std::size_t batch = 256;

  /// The numbers of `n` <= batch keys; count() grows by one with each new key.
  void number(const std::uint64_t* keys, std::size_t n, std::uint32_t* numbers) {
    if (8 * (count_ + batch) > 5 * slots_.size()) grow();
    std::uint64_t at[batch];
    for (std::size_t k = 0; k < n; ++k) {
      at[k] = place_of(keys[k]);
      __builtin_prefetch(&slots_[at[k]], 1);
    }
    for (std::size_t k = 0; k < n; ++k) {
      Slot& slot = find(keys[k], at[k]);
      if (slot.key == unused) slot = {keys[k], count_++};
      numbers[k] = slot.number;
    }
  }
  std::uint32_t count() const { return count_; }

 private:
  static constexpr std::uint64_t unused = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = unused;
    std::uint32_t number = 0;
  };

  /// Where a key's slot is, or the first to look at: the highest bits of its product with odd
  /// numbers.
  std::uint64_t place_of(std::uint64_t key) const {
    key *= 0x9e3779b97f4a7c15ull;
    key ^= key >> 32;
    return key * 0xd6e8feb86659fd93ull >> shift_;
  }
  Slot& find(std::uint64_t key, std::uint64_t at) {
    while (slots_[at].key != key && slots_[at].key != unused) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  void grow() {
    const int more = slots_.size() < std::size_t{1} << 18 ? 2 : 1;  // large tables less, or most of one may stay empty
    std::vector<Slot> old(slots_.size() << more);
    old.swap(slots_);
    shift_ -= more;
    for (const Slot& slot : old)
      if (slot.key != unused) find(slot.key, place_of(slot.key)) = slot;
  }

  int shift_ = 64 - 12;
  std::vector<Slot> slots_ =
      std::vector<Slot>(std::size_t{1} << 12);  ///< a power of two, at most 5/8 full
  std::uint32_t count_ = 0;
};

}  // namespace plumb
