#include "tile.hpp"

#include <algorithm>

#include "bit_stream.hpp"

namespace plumb::write_map {
namespace {

std::size_t slot_of(std::uint16_t place, std::size_t slots) {
  const std::uint32_t hash = place * 0x9e3779b1u;
  return static_cast<std::size_t>(std::uint64_t{hash} * slots >> 32);
}

/// Bits that a sum of `count` places takes.
int bits_of_sum(std::uint32_t count) { return std::bit_width(count * 65535u); }

std::vector<Cell> sorted(const std::vector<Cell>& slots, std::size_t used) {
  std::vector<std::uint64_t> order;  // sorted faster than the cells themselves
  order.reserve(used);
  for (std::size_t k = 0; k < slots.size(); ++k)
    if (slots[k].count) order.push_back(std::uint64_t{slots[k].place} << 32 | k);
  std::ranges::sort(order);
  std::vector<Cell> cells;
  cells.reserve(used);
  for (const auto at : order) cells.push_back(slots[at & 0xffffffffu]);
  return cells;
}

/// Calls body(cell) for each cell, in the order of their places.
template <class Body>
void unpack(const std::vector<std::uint64_t>& packed, std::size_t used, Body body) {
  BitReader bits(packed);
  std::uint32_t next = 0;
  for (std::size_t k = 0; k < used; ++k) {
    Cell cell;
    next += bits.get_short();
    cell.place = static_cast<std::uint16_t>(next - 1);
    cell.count = static_cast<std::uint16_t>(bits.get_short());
    for (auto& sum : cell.sum) sum = bits.get(bits_of_sum(cell.count));
    body(cell);
  }
}

}  // namespace

void Tile::prefetch(const Cell& cell) const {
  if (!slots_.empty()) __builtin_prefetch(&slots_[slot_of(cell.place, slots_.size())], 1);
}

void Tile::insert(const Cell& cell) {
  if (20 * (used_ + 1) > 17 * slots_.size()) grow();
  std::size_t at = slot_of(cell.place, slots_.size());
  while (slots_[at].count && slots_[at].place != cell.place)
    if (++at == slots_.size()) at = 0;
  if (slots_[at].count) return slots_[at].add(cell);
  slots_[at] = cell;
  ++used_;
}

void Tile::grow() {
  std::vector<Cell> old(slots_.size() + slots_.size() / 2 + 8);
  old.swap(slots_);
  used_ = 0;
  for (const auto& cell : old)
    if (cell.count) insert(cell);
}

void Tile::close() {
  if (closed() || used_ == 0) return;
  BitWriter bits;
  std::uint32_t next = 0;  // the least place that may come
  for (const auto& cell : sorted(slots_, used_)) {
    bits.put_short(cell.place + 1u - next);
    next = cell.place + 1u;
    bits.put_short(cell.count);
    for (const auto sum : cell.sum) bits.put(sum, bits_of_sum(cell.count));
  }
  packed_ = bits.take();
  slots_ = std::vector<Cell>();  // {} would keep the memory
}

void Tile::sink(io::ScratchFile& file) {
  if (packed_.empty()) return;
  place_ = file.append(packed_.data(), packed_bytes());
  words_ = static_cast<std::uint32_t>(packed_.size());
  file_ = &file;
  packed_ = std::vector<std::uint64_t>();
}

std::vector<std::uint64_t> Tile::packed() const {
  if (!file_) return packed_;
  std::vector<std::uint64_t> words(words_);
  file_->read(place_, words.data(), words.size() * sizeof words[0]);
  return words;
}

void Tile::open() {
  const auto packed = file_ ? this->packed() : std::move(packed_);
  packed_ = {};
  file_ = nullptr;
  const std::size_t cells = used_;
  slots_.assign(cells * 3 / 2 + 8, {});
  used_ = 0;
  unpack(packed, cells, [&](const Cell& cell) { insert(cell); });
}

std::vector<Cell> Tile::cells() const {
  if (!closed()) return sorted(slots_, used_);
  std::vector<Cell> cells;
  cells.reserve(used_);
  unpack(packed(), used_, [&](const Cell& cell) { cells.push_back(cell); });
  return cells;
}

}  // namespace plumb::write_map
