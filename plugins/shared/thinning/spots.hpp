#pragma once
/// A cloud thinned while it grows: one point for all that lie round the first of them.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace plumb::thinning {

/// A point within `edge` [m] of the first point of a spot belongs to it, else it is the first of a
/// new spot; what comes out is the mean of each, in the order of the first ones. Unlike cells of a
/// grid, spots have no sides that would cut a wall's noise in two: means of such parts lie beside
/// the wall, always on the same side where it runs along the grid, and rotate what is registered to
/// them. For submaps of some thousand points; they must lie within 2^20 voxels of the origin.
class Spots {
 public:
  explicit Spots(double edge)
      : per_edge_(static_cast<float>(1 / edge)),
        square_(static_cast<float>(edge * edge)),
        slots_(1 << 10) {}

  void add(float x, float y, float z) {
    const int column = cell_of(x), row = cell_of(y), layer = cell_of(z);
    std::uint32_t spot = near(column, row, layer, x, y, z);
    flat_ = flat_ && z == 0;
    for (const int dz : {0, -1, 1}) {
      if (dz != 0 && flat_) break;
      for (int n = 0; n < 9 && spot == none; ++n)
        spot = near(column + n % 3 - 1, row + n / 3 - 1, layer + dz, x, y, z);
    }
    if (spot != none) {
      Spot& s = spots_[spot];
      s.sum_x += x, s.sum_y += y, s.sum_z += z, s.n += 1;
      return;
    }
    if (2 * (spots_.size() + 1) >= slots_.size()) grow();
    Slot& slot = find(key_of(column, row, layer));
    slot.key = key_of(column, row, layer);
    spots_.push_back({x, y, z, slot.newest, x, y, z, 1});
    slot.newest = static_cast<std::uint32_t>(spots_.size() - 1);
  }

  /// The means, as anything with reserve and add, such as a Cloud.
  template <class Points>
  Points means() const {
    Points points;
    points.reserve(spots_.size());
    for (const Spot& s : spots_)
      points.add({static_cast<float>(s.sum_x / s.n), static_cast<float>(s.sum_y / s.n),
                  static_cast<float>(s.sum_z / s.n)});
    return points;
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t newest = none;  ///< of the spots that began in the cell
  };
  struct Spot {
    float x, y, z;         ///< the first point
    std::uint32_t before;  ///< the spot that began in the same cell before
    double sum_x, sum_y, sum_z, n;
  };

  int cell_of(float x) const { return static_cast<int>(std::floor(x * per_edge_)); }
  static std::uint64_t key_of(int column, int row, int layer) {
    const auto part = [](int n) { return static_cast<std::uint64_t>(n + (1 << 20)) & 0x1fffff; };
    return part(column) | part(row) << 21 | part(layer) << 42;
  }
  /// A spot that began in the cell and holds the place.
  std::uint32_t near(int column, int row, int layer, float x, float y, float z) {
    for (std::uint32_t k = find(key_of(column, row, layer)).newest; k != none;
         k = spots_[k].before) {
      const float dx = spots_[k].x - x, dy = spots_[k].y - y, dz = spots_[k].z - z;
      if (dx * dx + dy * dy + dz * dz <= square_) return k;
    }
    return none;
  }
  Slot& find(std::uint64_t key) {
    std::uint64_t at = key * 0x9e3779b97f4a7c15ull >> 20 & (slots_.size() - 1);
    while (slots_[at].newest != none && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  void grow() {
    std::vector<Slot> old(4 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.newest != none) find(slot.key) = slot;
  }

  float per_edge_, square_;
  bool flat_ = true;         ///< all z are 0 so far: other layers are empty
  std::vector<Slot> slots_;  ///< a power of two, at most half full
  std::vector<Spot> spots_;
};

}  // namespace plumb::thinning
