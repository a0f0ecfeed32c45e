#include "voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "give_back.hpp"
#include "plumb/data/error.hpp"

namespace plumb::write_map {
namespace {

constexpr double parts = 65536;         ///< of a cell's edge
constexpr std::int64_t half = 1 << 20;  ///< cells from the origin to either side

/// A cell is named by its tile, in 16, 16 and 15 bits for x, y, z, and its place there, in 5, 5 and
/// 6 bits.
std::uint64_t name_of(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return x >> 5 << 47 | y >> 5 << 31 | z >> 6 << 16 | (x & 31) << 11 | (y & 31) << 6 | (z & 63);
}
std::array<std::int64_t, 3> cell_of(std::uint64_t tile, std::uint16_t place) {
  return {static_cast<std::int64_t>(tile >> 31 << 5 | place >> 11) - half,
          static_cast<std::int64_t>((tile >> 15 & 0xffff) << 5 | (place >> 6 & 31)) - half,
          static_cast<std::int64_t>((tile & 0x7fff) << 6 | (place & 63)) - half};
}

/// splitmix64's finisher: neighbouring names far apart.
std::uint64_t hash_of(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

struct NamedCell {
  std::uint64_t name;
  Cell cell;
};

/// Numbers the tiles of a frame in the order of their first cells.
class TileNumbers {
 public:
  explicit TileNumbers(std::vector<VoxelMap::FrameCells::Part>& of_frame) : parts_(of_frame) {}
  std::uint32_t of(std::uint64_t tile) {
    if (2 * (parts_.size() + 1) > slots_.size()) grow();
    auto& slot = slots_[place_of(tile)];
    if (slot == 0) {
      parts_.push_back({tile, 0, 0});
      slot = static_cast<std::uint32_t>(parts_.size());
    }
    return slot - 1;
  }

 private:
  std::size_t place_of(std::uint64_t tile) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (tile * 0x9e3779b97f4a7c15ull) >> 32 & mask;
    while (slots_[at] && parts_[slots_[at] - 1].tile != tile) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), 0);
    for (std::uint32_t k = 0; k < parts_.size(); ++k) slots_[place_of(parts_[k].tile)] = k + 1;
  }
  std::vector<VoxelMap::FrameCells::Part>& parts_;
  std::vector<std::uint32_t> slots_ =
      std::vector<std::uint32_t>(1024, 0);  ///< number + 1; at most half full
};

/// In order of tiles, and within a tile in order of appearance.
VoxelMap::FrameCells by_tile(const std::vector<NamedCell>& found) {
  VoxelMap::FrameCells frame;
  TileNumbers number(frame.parts);
  std::vector<std::uint32_t> part(found.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    part[k] = number.of(found[k].name >> 16);
    ++frame.parts[part[k]].end;
  }
  std::uint32_t sum = 0;
  for (auto& p : frame.parts) {
    sum += p.end;
    p.first = p.end = sum - p.end;
  }
  frame.cells.resize(found.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    frame.cells[frame.parts[part[k]].end++] = found[k].cell;
  return frame;
}

template <class Body>
void each(const parallel::Loop& parallel, std::size_t count, const Body& body) {
  constexpr std::size_t together = 8;  // tiles a task: most are small
  parallel((count + together - 1) / together, [&](std::size_t task) {
    for (std::size_t k = task * together; k < std::min(count, (task + 1) * together); ++k) body(k);
  });
}

}  // namespace

VoxelMap::FrameCells VoxelMap::cells_of(const Cloud& cloud, const Pose& T_world_cloud) const {
  const Eigen::Matrix3d r = T_world_cloud.matrix() / leaf_;
  const Eigen::Vector3d t = (T_world_cloud.translation - origin_) / leaf_;
  std::uint64_t too_far = 0;
  std::vector<NamedCell> found;
  found.reserve(cloud.size() / 2);
  // Points of one cell come close together in a frame, so a small table of its own finds most of
  // them in the cache.
  const std::size_t mask = std::bit_ceil(2 * cloud.size() + 2) - 1;
  std::vector<std::uint32_t> table(mask + 1, 0);  // place in `found` + 1
  const auto whole = static_cast<double>(half);
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const double x = cloud.x[k], y = cloud.y[k], z = cloud.z[k];
    double v[3], floor[3];
    bool near = true;
    for (int a = 0; a < 3; ++a) {
      v[a] = r(a, 0) * x + r(a, 1) * y + r(a, 2) * z + t[a];
      floor[a] = std::floor(v[a]);
      near = near && floor[a] > -whole && floor[a] < whole;  // also false for what is no number
    }
    if (!near) {
      ++too_far;
      continue;
    }
    std::uint64_t at_cell[3];
    Cell cell;
    cell.count = 1;
    for (int a = 0; a < 3; ++a) {
      at_cell[a] = static_cast<std::uint64_t>(static_cast<std::int64_t>(floor[a]) + half);
      cell.sum[a] = std::min(static_cast<std::uint32_t>((v[a] - floor[a]) * parts), Cell::most);
    }
    const std::uint64_t name = name_of(at_cell[0], at_cell[1], at_cell[2]);
    cell.place = static_cast<std::uint16_t>(name);
    std::size_t at = hash_of(name) & mask;
    while (table[at] && found[table[at] - 1].name != name) at = (at + 1) & mask;
    if (table[at]) {
      found[table[at] - 1].cell.add(cell);
    } else {
      found.push_back({name, cell});
      table[at] = static_cast<std::uint32_t>(found.size());
    }
  }
  FrameCells frame = by_tile(found);
  frame.too_far = too_far;
  return frame;
}

void VoxelMap::add(std::span<const FrameCells> frames, const parallel::Loop& parallel,
                   std::size_t idle) {
  struct Piece {
    std::uint64_t tile;
    std::uint32_t frame, part;
    auto operator<=>(const Piece&) const = default;
  };
  std::vector<Piece> pieces;
  for (std::uint32_t f = 0; f < frames.size(); ++f)
    for (std::uint32_t p = 0; p < frames[f].parts.size(); ++p)
      pieces.push_back({frames[f].parts[p].tile, f, p});
  std::ranges::sort(pieces);

  struct Work {
    Tile* tile;
    std::size_t first, end;  // pieces
  };
  std::vector<Work> work;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (k == 0 || pieces[k].tile != pieces[k - 1].tile) {
      Entry& entry = tiles_[pieces[k].tile];
      if (entry.tile.closed() || entry.tile.size() == 0) open_.push_back(&entry);
      work.push_back({&entry.tile, k, k});
      entry.last = frames_ + frames.size();
    }
    ++work.back().end;
  }
  constexpr std::uint32_t ahead = 8;  // cells whose slots are fetched early
  each(parallel, work.size(), [&](std::size_t k) {
    for (std::size_t n = work[k].first; n < work[k].end; ++n) {
      const FrameCells& frame = frames[pieces[n].frame];
      const auto& part = frame.parts[pieces[n].part];
      for (auto c = part.first; c < part.end; ++c) {
        if (c + ahead < part.end) work[k].tile->prefetch(frame.cells[c + ahead]);
        work[k].tile->add(frame.cells[c]);
      }
    }
  });

  frames_ += frames.size();
  const auto still = std::partition(open_.begin(), open_.end(),
                                    [&](const Entry* e) { return e->last + idle > frames_; });
  const std::span<Entry* const> idle_ones(still, open_.end());
  each(parallel, idle_ones.size(), [&](std::size_t k) { idle_ones[k]->tile.close(); });
  sink(idle_ones, parallel);
  open_.erase(still, open_.end());
}

/// Once the closed tiles take more memory than they may, all of them go to disk, and from then on
/// each that is closed.
void VoxelMap::sink(std::span<Entry* const> closed, const parallel::Loop& parallel) {
  if (!scratch_) {
    for (const Entry* entry : closed)
      packed_ +=
          entry->tile
              .packed_bytes();  // one that was opened meanwhile counts twice: about is enough
    if (packed_ <= memory_) return;
    try {
      scratch_ = std::make_unique<io::ScratchFile>();
    } catch (const Error&) {  // then it has to be memory
      memory_ = std::numeric_limits<std::size_t>::max();
      return;
    }
    for (auto& [key, entry] : tiles_) entry.tile.sink(*scratch_);
  }
  each(parallel, closed.size(), [&](std::size_t k) { closed[k]->tile.sink(*scratch_); });
}

std::size_t VoxelMap::size() const {
  std::size_t n = 0;
  for (const auto& [key, entry] : tiles_) n += entry.tile.size();
  return n;
}

std::size_t VoxelMap::open() const {
  std::size_t n = 0;
  for (const auto* entry : open_) n += entry->tile.size();
  return n;
}

void VoxelMap::write(FileBytes& bytes) {
  std::vector<std::uint64_t> order;
  for (const auto& [key, entry] : tiles_) order.push_back(key);
  std::ranges::sort(order);
  constexpr std::size_t stretch =
      8 << 20;  // bytes after which the memory of the tiles written is given back
  give_back();
  std::size_t next = bytes.size() + stretch;
  for (const auto key : order) {
    if (bytes.size() >= next) {
      give_back();
      next = bytes.size() + stretch;
    }
    const auto tile = tiles_.extract(key);
    for (const auto& cell : tile.mapped().tile.cells()) {
      const auto at = cell_of(key, cell.place);
      float place[3];
      for (int a = 0; a < 3; ++a) {
        // Each place was rounded down to a 65536th; half of one puts the mean back.
        const double inside = (static_cast<double>(cell.sum[a]) / cell.count + 0.5) / parts;
        place[a] = static_cast<float>(leaf_ * (static_cast<double>(at[a]) + inside));
      }
      bytes.append({reinterpret_cast<const char*>(place), sizeof place});
    }
  }
  open_.clear();
}

}  // namespace plumb::write_map
