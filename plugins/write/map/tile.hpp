#pragma once
/// A box of 32 x 32 x 64 cells: a table while points fall into it, packed bits while none do.

#include <array>
#include <cstdint>
#include <vector>

#include "plumb/data/io/scratch_file.hpp"

namespace plumb::write_map {

/// One occupied cell: where in its tile it is, how many points it has had, and the sum of their
/// places inside it. 16 bytes.
///
/// A place inside is counted in 65536ths of the cell's edge (1.5 um at 0.1 m), so sums are whole
/// numbers: the mean does not depend on the order of the points, and nothing is lost far from the
/// origin. After 65535 points a cell takes no more.
struct Cell {
  static constexpr std::uint32_t most = 65535;  ///< points in a cell: 65535 * 65535 fits 32 bits

  std::uint16_t place = 0;  ///< x, y, z in 5, 5 and 6 bits
  std::uint16_t count = 0;  ///< 0: no cell
  std::array<std::uint32_t, 3> sum{};

  /// Takes the points of `other`, all or none.
  void add(const Cell& other) {
    if (count + other.count > most) return;
    count = static_cast<std::uint16_t>(count + other.count);
    for (int a = 0; a < 3; ++a) sum[a] += other.sum[a];
  }
};

class Tile {
 public:
  /// Adds the points to the cell that they name; opens the tile if it is closed.
  void add(const Cell& cell) {
    if (closed()) open();
    insert(cell);
  }
  /// Brings the place of a cell into the cache, should it be open.
  void prefetch(const Cell& cell) const;
  /// Packs the cells, without loss, into about a third of the memory.
  void close();
  bool closed() const { return !packed_.empty() || file_; }
  /// Moves the packed cells into a file that outlives this; nothing happens while it is open.
  /// Throws Error when the disk does not take them.
  void sink(io::ScratchFile& file);
  /// Memory that the packed cells take [bytes].
  std::size_t packed_bytes() const { return packed_.size() * sizeof(std::uint64_t); }
  std::size_t size() const { return used_; }  ///< cells

  /// The cells in the order of their places.
  std::vector<Cell> cells() const;

 private:
  void insert(const Cell& cell);
  void grow();
  void open();
  std::vector<std::uint64_t> packed() const;

  std::vector<Cell> slots_;            ///< open addressing; grows by half, so it is 57 to 85 % full
  std::vector<std::uint64_t> packed_;  ///< where it has words, slots_ has none
  const io::ScratchFile* file_ = nullptr;  ///< where they are if not in packed_
  std::uint64_t place_ = 0;
  std::uint32_t words_ = 0;
  std::uint32_t used_ = 0;
};

}  // namespace plumb::write_map
