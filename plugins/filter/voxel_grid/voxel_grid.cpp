#include "voxel_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "cell_index.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"

namespace plumb {
namespace {

constexpr double most_cells = 1 << 21;

bool all_finite(const std::vector<float>& values) {
  std::uint32_t special = 0;
  for (const float v : values)
    special += (std::bit_cast<std::uint32_t>(v) & 0x7f800000u) == 0x7f800000u;
  return special == 0;
}

/// The cells along one axis, counted from the lowest.
struct Axis {
  const std::vector<float>& values;
  double per_metre, low = 0;

  Axis(const std::vector<float>& v, double leaf, const char* name)
      : values(v), per_metre(1 / leaf) {
    float least = v[0], greatest = v[0];
    for (const float value : v) {
      least = value < least ? value : least;
      greatest = value > greatest ? value : greatest;
    }
    low = std::floor(least * per_metre);
    if (std::floor(greatest * per_metre) - low >= most_cells)
      throw Error(std::string("the cloud reaches from ") + short_number(least) + " m to " +
                  short_number(greatest) + " m along " + name +
                  ", which is more than 2^21 cells of " + short_number(leaf) +
                  " m: drop far points with filter.distance, or raise leaf");
  }
  void cells(std::size_t first, std::size_t n, std::uint32_t* to) const {
    for (std::size_t k = 0; k < n; ++k)
      to[k] = static_cast<std::uint32_t>(
          static_cast<std::int32_t>(std::floor(values[first + k] * per_metre) - low));
  }
};

/// What a cell gathers.
struct Cell {
  double x = 0, y = 0, z = 0, intensity = 0;
  float nearest =
      std::numeric_limits<float>::infinity();  ///< squared distance from which it was seen [m^2]
  std::uint32_t count = 0;
  std::uint16_t frame = 0;
};

/// Cells by number, in blocks, so that growing moves none of them.
class Cells {
 public:
  Cell& operator[](std::uint32_t number) {
    return blocks_[number >> bits][number & ((1u << bits) - 1)];
  }
  /// Room for cells up to `count`.
  void grow(std::uint32_t count) {
    while (blocks_.size() << bits < count) blocks_.push_back(std::make_unique<Cell[]>(1u << bits));
  }

 private:
  static constexpr int bits = 11;
  std::vector<std::unique_ptr<Cell[]>> blocks_;
};

/// Calls body(first, n, numbers) for batches of points first .. first+n-1 with their cells'
/// numbers, and `grown(count)` before it.
template <class Grown, class Body>
std::uint32_t number_cells(const Cloud& cloud, double leaf, Grown grown, Body body) {
  const Axis x(cloud.x, leaf, "x"), y(cloud.y, leaf, "y"), z(cloud.z, leaf, "z");
  constexpr std::size_t batch = CellIndex::batch;
  CellIndex index;
  std::uint64_t keys[batch];
  std::uint32_t cx[batch], cy[batch], cz[batch], numbers[batch];
  for (std::size_t first = 0; first < cloud.size(); first += batch) {
    const std::size_t n = std::min(batch, cloud.size() - first);
    x.cells(first, n, cx);
    y.cells(first, n, cy);
    z.cells(first, n, cz);
    for (std::size_t k = 0; k < n; ++k)
      keys[k] = std::uint64_t{cx[k]} << 42 | std::uint64_t{cy[k]} << 21 | cz[k];
    index.number(keys, n, numbers);
    grown(index.count());
    body(first, n, numbers);
  }
  return index.count();
}

/// Sums of normals by cell, then their directions.
struct Normals {
  std::vector<Eigen::Vector3f> sum, first;

  void add(std::uint32_t cell, const Eigen::Vector3f& normal) {
    if (cell == sum.size()) {
      sum.push_back(normal);
      first.push_back(normal);
    } else {
      sum[cell] += normal;
    }
  }
  void write(Cloud& to) const {
    for (std::size_t c = 0; c < sum.size(); ++c) {
      const float length = sum[c].norm();
      const Eigen::Vector3f normal = length > 1e-3f ? Eigen::Vector3f(sum[c] / length) : first[c];
      to.nx.push_back(normal.x());
      to.ny.push_back(normal.y());
      to.nz.push_back(normal.z());
    }
  }
};

/// `cloud` has finite points only, and at least one.
template <bool has_intensity, bool has_frames>
Thinned thin_finite(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
                    const std::vector<Eigen::Vector3f>& origins, double leaf) {
  Cells cells;
  Normals normals;
  const bool has_normals = cloud.has_normals();
  const auto add = [&](std::size_t k, Cell& cell) {
    cell.x += cloud.x[k];
    cell.y += cloud.y[k];
    cell.z += cloud.z[k];
    ++cell.count;
    if constexpr (has_intensity) cell.intensity += cloud.intensity[k];
    if constexpr (has_frames) {
      const float distance = (cloud.point(k) - origins[frame[k]]).squaredNorm();
      if (distance < cell.nearest) cell.nearest = distance, cell.frame = frame[k];
    }
  };
  const std::uint32_t count = number_cells(
      cloud, leaf, [&](std::uint32_t so_far) { cells.grow(so_far); },
      [&](std::size_t first, std::size_t n, const std::uint32_t* numbers) {
        for (std::size_t k = 0; k < n; ++k) __builtin_prefetch(&cells[numbers[k]], 1);
        for (std::size_t k = 0; k < n; ++k) add(first + k, cells[numbers[k]]);
        if (has_normals)
          for (std::size_t k = 0; k < n; ++k) normals.add(numbers[k], cloud.normal(first + k));
      });

  Thinned result;
  result.cloud.reserve(count);
  if constexpr (has_intensity) result.cloud.intensity.reserve(count);
  if constexpr (has_frames) result.frame.reserve(count);
  for (std::uint32_t c = 0; c < count; ++c) {
    const Cell& cell = cells[c];
    const double share = 1.0 / cell.count;
    result.cloud.add(Eigen::Vector3d(share * cell.x, share * cell.y, share * cell.z).cast<float>());
    if constexpr (has_intensity)
      result.cloud.intensity.push_back(static_cast<float>(share * cell.intensity));
    if constexpr (has_frames) result.frame.push_back(cell.frame);
  }
  normals.write(result.cloud);
  return result;
}

Thinned thin_finite(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
                    const std::vector<Eigen::Vector3f>& origins, double leaf) {
  const bool intensity = cloud.intensity.size() == cloud.size();
  if (frame.empty())
    return intensity ? thin_finite<true, false>(cloud, frame, origins, leaf)
                     : thin_finite<false, false>(cloud, frame, origins, leaf);
  return intensity ? thin_finite<true, true>(cloud, frame, origins, leaf)
                   : thin_finite<false, true>(cloud, frame, origins, leaf);
}

}  // namespace

Thinned thin(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
             const std::vector<Eigen::Vector3f>& origins, double leaf) {
  if (cloud.empty()) return {};
  if (all_finite(cloud.x) && all_finite(cloud.y) && all_finite(cloud.z))
    return thin_finite(cloud, frame, origins, leaf);

  std::vector<std::uint32_t> finite;
  std::vector<std::uint16_t> their_frames;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (!cloud.point(k).allFinite()) continue;
    finite.push_back(static_cast<std::uint32_t>(k));
    if (!frame.empty()) their_frames.push_back(frame[k]);
  }
  Thinned result;
  if (!finite.empty()) result = thin_finite(select(cloud, finite), their_frames, origins, leaf);
  result.dropped = cloud.size() - finite.size();
  return result;
}

Thinned thin(const Segment& segment, double leaf) {
  std::vector<Eigen::Vector3f> origins;
  for (const Pose& pose : segment.range.T_segment_frame)
    origins.push_back(pose.translation.cast<float>());
  return thin(segment.cloud, segment.frame, origins, leaf);
}

}  // namespace plumb
