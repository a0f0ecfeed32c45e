#include "voxel_map.hpp"

#include <bit>
#include <cmath>

namespace plumb {
namespace {

constexpr double parts = 65536;           ///< of a cell's edge
constexpr std::int64_t half = 1 << 20;    ///< cells from the origin to either side
constexpr std::uint32_t most = 65535;     ///< points in a cell: 65535 * 65535 fits 32 bits

/// splitmix64's finisher: neighbouring keys far apart.
std::uint64_t hash_of(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
/// A place in 0 .. n-1 from the hash's high bits.
std::size_t slot_of(std::uint64_t hash, std::size_t n) {
  return static_cast<std::size_t>((static_cast<unsigned __int128>(hash) * n) >> 64);
}
std::size_t shard_of(std::uint64_t hash) { return hash & (VoxelMap::shards - 1); }

void merge(Voxel& into, const Voxel& from) {
  if (into.count + from.count > most) return;
  into.count += from.count;
  for (int a = 0; a < 3; ++a) into.sum[a] += from.sum[a];
}

}  // namespace

void VoxelTable::add(const Voxel& voxel) {
  if (20 * (used_ + 1) > 17 * slots_.size()) grow();
  std::size_t at = slot_of(hash_of(voxel.key), slots_.size());
  while (slots_[at].key != voxel.key) {
    if (slots_[at].key == 0) {
      slots_[at] = voxel;
      ++used_;
      return;
    }
    if (++at == slots_.size()) at = 0;
  }
  merge(slots_[at], voxel);
}

void VoxelTable::prefetch(std::uint64_t key) const {
  __builtin_prefetch(&slots_[slot_of(hash_of(key), slots_.size())], 1);
}

void VoxelTable::grow() {
  std::vector<Voxel> old(slots_.size() + slots_.size() / 2 + 8);
  old.swap(slots_);
  used_ = 0;
  for (const auto& voxel : old)
    if (voxel.key) add(voxel);
}

VoxelMap::Cells VoxelMap::cells_of(const Cloud& cloud, const Pose& T_world_cloud) const {
  const Eigen::Matrix3d r = T_world_cloud.matrix() / leaf_;
  const Eigen::Vector3d t = (T_world_cloud.translation - origin_) / leaf_;
  Cells cells;
  std::vector<Voxel> found;
  found.reserve(cloud.size() / 4);
  // Points of one cell come close together in a frame, so a small table of its own finds most of them in the cache.
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
      ++cells.too_far;
      continue;
    }
    Voxel voxel;
    voxel.count = 1;
    for (int a = 0; a < 3; ++a) {
      voxel.key = voxel.key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(floor[a]) + half);
      voxel.sum[a] = static_cast<std::uint32_t>((v[a] - floor[a]) * parts);
      if (voxel.sum[a] > most) voxel.sum[a] = most;
    }
    std::size_t at = hash_of(voxel.key) & mask;
    while (table[at] && found[table[at] - 1].key != voxel.key) at = (at + 1) & mask;
    if (table[at]) {
      merge(found[table[at] - 1], voxel);
    } else {
      found.push_back(voxel);
      table[at] = static_cast<std::uint32_t>(found.size());
    }
  }
  // In order of shards, and within a shard in order of appearance.
  std::array<std::uint32_t, shards + 1> next{};
  for (const auto& voxel : found) ++next[shard_of(hash_of(voxel.key)) + 1];
  for (std::size_t s = 0; s < shards; ++s) next[s + 1] += next[s];
  cells.first = next;
  cells.voxels.resize(found.size());
  for (const auto& voxel : found) cells.voxels[next[shard_of(hash_of(voxel.key))]++] = voxel;
  return cells;
}

void VoxelMap::add(const Cells& cells, std::size_t shard) {
  constexpr std::uint32_t ahead = 12;  // cells whose slots are fetched early: the table is larger than the cache
  const std::uint32_t end = cells.first[shard + 1];
  for (std::uint32_t k = cells.first[shard]; k < end; ++k) {
    if (k + ahead < end) tables_[shard].prefetch(cells.voxels[k + ahead].key);
    tables_[shard].add(cells.voxels[k]);
  }
}

std::size_t VoxelMap::size() const {
  std::size_t n = 0;
  for (const auto& table : tables_) n += table.size();
  return n;
}

Cloud VoxelMap::take() {
  Cloud cloud;
  cloud.reserve(size());
  for (auto& table : tables_) {
    for (const auto& voxel : table.slots()) {
      if (voxel.key == 0) continue;
      double place[3];
      for (int a = 0; a < 3; ++a) {
        const auto cell = static_cast<std::int64_t>(voxel.key >> (21 * (2 - a)) & 0x1fffff) - half;
        // Each place was rounded down to a 65536th; half of one puts the mean back.
        const double inside = (static_cast<double>(voxel.sum[a]) / voxel.count + 0.5) / parts;
        place[a] = leaf_ * (static_cast<double>(cell) + inside);
      }
      cloud.add(Eigen::Vector3d(place[0], place[1], place[2]).cast<float>());
    }
    table = VoxelTable(1);
  }
  return cloud;
}

}  // namespace plumb
