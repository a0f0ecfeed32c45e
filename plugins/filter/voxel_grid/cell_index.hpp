#pragma once
/// Numbers the occupied cells of a grid, fast where neighbours in the input are neighbours in
/// space.

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

/// Gives each cell (x, y, z) that it is asked for a number, 0, 1, 2 ... in the order of first
/// asking. Coordinates are 21 bits each.
///
/// Cells are kept in blocks of 4 x 4 x 4. A hash table finds the block, and the block holds the
/// numbers of its cells. Points of a scan line, and of the next frame's, mostly lie in the block of
/// the point before: for these no table is asked.
class CellIndex {
 public:
  CellIndex() : table_(1024) {}

  /// The cell's number; `count()` grows by one if it is new.
  std::uint32_t of(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::uint64_t key =
        (std::uint64_t{x >> 2} << 38 | std::uint64_t{y >> 2} << 19 | z >> 2) + 1;
    if (key != last_key_) {
      last_ = block(key);
      last_key_ = key;
    }
    std::uint32_t& number = blocks_[last_][(x & 3) << 4 | (y & 3) << 2 | (z & 3)];
    if (number == none) number = count_++;
    return number;
  }
  std::uint32_t count() const { return count_; }

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  using Block = std::array<std::uint32_t, 64>;
  struct Slot {
    std::uint64_t key = 0;  ///< 0 is free
    std::uint32_t block = 0;
  };

  Slot& slot_of(std::uint64_t key) {
    const std::size_t mask = table_.size() - 1;
    std::size_t at = (key * 0x9e3779b97f4a7c15ull) >> 20 & mask;
    while (table_[at].key != 0 && table_[at].key != key) at = (at + 1) & mask;
    return table_[at];
  }
  std::uint32_t block(std::uint64_t key) {
    Slot* slot = &slot_of(key);
    if (slot->key == key) return slot->block;
    if (2 * blocks_.size() >= table_.size()) {
      grow();
      slot = &slot_of(key);
    }
    *slot = {key, static_cast<std::uint32_t>(blocks_.size())};
    blocks_.emplace_back().fill(none);
    return slot->block;
  }
  void grow() {
    std::vector<Slot> old(2 * table_.size());
    old.swap(table_);
    for (const Slot& slot : old)
      if (slot.key != 0) slot_of(slot.key) = slot;
  }

  std::vector<Slot> table_;  ///< open addressing; a power of two, at most half full
  std::vector<Block> blocks_;
  std::uint64_t last_key_ = 0;
  std::uint32_t last_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace plumb
