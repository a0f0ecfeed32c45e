#pragma once
/// Finds the occupied cells of a grid by their keys.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace plumb::thinning {

/// Cells, plain structs with a `key`, numbered 0, 1, 2 ... in the order in which their keys are
/// first asked for.
///
/// A hash table with open addressing holds their numbers and a part of their hashes; the cells,
/// which alone know their keys, lie in blocks, which growing does not move. Most of both is far
/// from the processor, so keys come in batches: all their slots and then all their cells are
/// fetched ahead, and the waits overlap.
template <class Cell>
class CellTable {
 public:
  static constexpr std::size_t batch = 256;

  /// The numbers of `n` <= batch keys. A cell that is new is zero but for its key.
  void find(const std::uint64_t* keys, std::size_t n, std::uint32_t* numbers) {
    if (4 * (count_ + batch) > 3 * slots_.size()) grow();
    std::uint64_t hashes[batch];
    std::size_t at[batch];
    for (std::size_t k = 0; k < n; ++k) {
      hashes[k] = hash_of(keys[k]);
      __builtin_prefetch(&slots_[place_of(hashes[k])], 1);
    }
    for (std::size_t k = 0; k < n; ++k) {
      at[k] = next(place_of(hashes[k]), hashes[k]);
      if (slots_[at[k]].number) __builtin_prefetch(&(*this)[slots_[at[k]].number - 1], 1);
    }
    for (std::size_t k = 0; k < n; ++k) numbers[k] = number_of(keys[k], hashes[k], at[k]);
  }
  std::uint32_t count() const { return count_; }
  /// Hands on all cells in order, and lets go of their memory meanwhile.
  template <class Take>
  void take(const Take& take) {
    slots_ = std::vector<Slot>();
    for (std::uint32_t number = 0; number < count_; ++number) {
      take((*this)[number]);
      const std::uint32_t next = number + 1 + first_block;
      if (std::has_single_bit(next))
        blocks_[static_cast<std::size_t>(std::bit_width(next) - std::bit_width(first_block)) - 1]
            .reset();
    }
  }

  Cell& operator[](std::uint32_t number) {
    const std::uint32_t shifted = number + first_block;  // block b holds first_block << b cells
    const int block = std::bit_width(shifted) - std::bit_width(first_block);
    return blocks_[static_cast<std::size_t>(block)][shifted - (first_block << block)];
  }

 private:
  static constexpr std::uint32_t first_block = 512;
  struct Slot {
    std::uint32_t number = 0;  ///< of the cell, + 1; 0: unused
    std::uint32_t hash = 0;    ///< the low half: another one is another cell
  };

  static std::uint64_t hash_of(std::uint64_t key) {
    key *= 0x9e3779b97f4a7c15ull;
    key ^= key >> 32;
    return key * 0xd6e8feb86659fd93ull;
  }
  /// Where a key's slot is, or the first to look at: the highest bits of its hash.
  std::size_t place_of(std::uint64_t hash) const {
    return static_cast<std::size_t>(hash >> shift_);
  }
  /// From `at` on, the first slot that may be the key's or is unused.
  std::size_t next(std::size_t at, std::uint64_t hash) const {
    while (slots_[at].number && slots_[at].hash != static_cast<std::uint32_t>(hash))
      at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  std::uint32_t number_of(std::uint64_t key, std::uint64_t hash, std::size_t at) {
    for (at = next(at, hash); slots_[at].number; at = next((at + 1) & (slots_.size() - 1), hash))
      if ((*this)[slots_[at].number - 1].key == key) return slots_[at].number - 1;
    add_block();
    ((*this)[count_] = Cell{}).key = key;
    slots_[at] = {++count_, static_cast<std::uint32_t>(hash)};
    return count_ - 1;
  }
  void add_block() {
    const std::uint32_t shifted = count_ + first_block;
    if (!std::has_single_bit(shifted)) return;
    blocks_[static_cast<std::size_t>(std::bit_width(shifted) - std::bit_width(first_block))] =
        std::make_unique_for_overwrite<Cell[]>(shifted);
  }
  /// The cells know their keys, so the old table need not stay while the new one is filled.
  void grow() {
    slots_ = std::vector<Slot>();
    slots_.resize(std::size_t{1} << (64 - --shift_));
    for (std::uint32_t number = 0; number < count_; ++number) {
      const std::uint64_t hash = hash_of((*this)[number].key);
      std::size_t at = place_of(hash);
      while (slots_[at].number) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = {number + 1, static_cast<std::uint32_t>(hash)};
    }
  }

  int shift_ = 64 - 10;
  std::vector<Slot> slots_ =
      std::vector<Slot>(std::size_t{1} << 10);  ///< a power of two, at most 3/4 full
  std::array<std::unique_ptr<Cell[]>, 23> blocks_;
  std::uint32_t count_ = 0;
};

}  // namespace plumb::thinning
