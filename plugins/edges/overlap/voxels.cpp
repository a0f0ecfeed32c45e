#include "voxels.hpp"

#include <array>

namespace plumb::edges_overlap {
namespace {

constexpr int coarse_shift = 9;  // three levels of three bits

/// Puts two zeros between the low 21 bits.
std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x001f00000000ffffull;
  v = (v | v << 16) & 0x001f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

/// Sorts codes of `bits` bits by digits of 11 bits, lowest first.
void radix_sort(std::vector<std::uint64_t>& codes, int bits) {
  constexpr int digit = 11;
  std::vector<std::uint64_t> other(codes.size());
  for (int shift = 0; shift < bits; shift += digit) {
    std::array<std::uint32_t, 1 << digit> place{};
    const auto of = [shift](std::uint64_t code) { return code >> shift & ((1 << digit) - 1); };
    for (const auto code : codes) ++place[of(code)];
    std::uint32_t sum = 0;
    for (auto& p : place) {
      const std::uint32_t count = p;
      p = sum;
      sum += count;
    }
    for (const auto code : codes) other[place[of(code)]++] = code;
    codes.swap(other);
  }
}

}  // namespace

std::uint64_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

Voxels voxels_of(const Cloud& cloud, const Pose& T_world_segment, const Lattice& lattice) {
  const overlapping::Cells cells(T_world_segment, lattice);
  std::vector<std::uint64_t> codes;
  codes.reserve(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3d cell = cells.of(cloud.point(k));
    if (!overlapping::Cells::within(cell, overlapping::most_bits)) continue;  // non-finite
    codes.push_back(morton(static_cast<std::uint32_t>(cell.x()),
                           static_cast<std::uint32_t>(cell.y()),
                           static_cast<std::uint32_t>(cell.z())));
  }
  radix_sort(codes, 3 * lattice.bits);

  Voxels voxels;
  voxels.points = codes.size();
  for (std::size_t k = 0; k < codes.size();) {
    const auto first = k;
    while (k < codes.size() && codes[k] == codes[first]) ++k;
    const auto count = static_cast<std::uint32_t>(k - first);
    if (voxels.coarse.empty() || voxels.coarse.back() != codes[first] >> coarse_shift) {
      voxels.coarse.push_back(codes[first] >> coarse_shift);
      voxels.coarse_begin.push_back(static_cast<std::uint32_t>(voxels.codes.size()));
      voxels.coarse_counts.push_back(0);
    }
    voxels.codes.push_back(codes[first]);
    voxels.counts.push_back(count);
    voxels.coarse_counts.back() += count;
  }
  voxels.coarse_begin.push_back(static_cast<std::uint32_t>(voxels.codes.size()));
  return voxels;
}

double overlap(const Voxels& a, const Voxels& b, double least) {
  const auto both = static_cast<double>(a.points + b.points);
  if (a.points == 0 || b.points == 0) return 0;
  // Both lists are sorted: walk them side by side and show every common code's places to `found`.
  const auto common = [](const auto& left, std::size_t l, std::size_t l_end, const auto& right,
                         std::size_t r, std::size_t r_end, const auto& found) {
    while (l < l_end && r < r_end) {
      const auto x = left[l], y = right[r];
      if (x == y) found(l, r);
      l += x <= y;
      r += y <= x;
    }
  };
  std::uint64_t at_most = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;
  common(a.coarse, 0, a.coarse.size(), b.coarse, 0, b.coarse.size(),
         [&](std::size_t k, std::size_t n) {
           at_most += a.coarse_counts[k] + b.coarse_counts[n];
           shared.emplace_back(k, n);
         });
  if (static_cast<double>(at_most) <= least * both) return 0;
  std::uint64_t points = 0;
  for (const auto& [k, n] : shared)
    common(a.codes, a.coarse_begin[k], a.coarse_begin[k + 1], b.codes, b.coarse_begin[n],
           b.coarse_begin[n + 1],
           [&](std::size_t x, std::size_t y) { points += a.counts[x] + b.counts[y]; });
  return static_cast<double>(points) / both;
}

}  // namespace plumb::edges_overlap
