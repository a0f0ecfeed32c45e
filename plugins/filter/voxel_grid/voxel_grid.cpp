#include "voxel_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "cell_index.hpp"
#include "plumb/data/error.hpp"

namespace plumb {
namespace {

constexpr double most_cells = 1 << 21;
constexpr std::size_t chunk = 512;  ///< points whose cells are reckoned together

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
      throw Error(std::string("the cloud reaches from ") + std::to_string(least) + " m to " +
                  std::to_string(greatest) + " m along " + name +
                  ", which is more than 2^21 cells of " + std::to_string(leaf) +
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
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double intensity = 0;
  float nearest =
      std::numeric_limits<float>::infinity();  ///< squared distance from which it was seen [m^2]
  std::uint32_t count = 0;
  std::uint16_t frame = 0;
};

/// The cell's number of each point; a new cell is `made`.
template <class Body>
std::uint32_t for_each_cell(const Cloud& cloud, double leaf, Body body) {
  const Axis x(cloud.x, leaf, "x"), y(cloud.y, leaf, "y"), z(cloud.z, leaf, "z");
  CellIndex index;
  std::uint32_t cx[chunk], cy[chunk], cz[chunk];
  for (std::size_t first = 0; first < cloud.size(); first += chunk) {
    const std::size_t n = std::min(chunk, cloud.size() - first);
    x.cells(first, n, cx);
    y.cells(first, n, cy);
    z.cells(first, n, cz);
    for (std::size_t k = 0; k < n; ++k) body(first + k, index.of(cx[k], cy[k], cz[k]));
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
  std::vector<Cell> cells;
  Normals normals;
  const bool has_normals = cloud.has_normals();
  for_each_cell(cloud, leaf, [&](std::size_t k, std::uint32_t number) {
    if (number == cells.size()) cells.emplace_back();
    Cell& cell = cells[number];
    const Eigen::Vector3f p = cloud.point(k);
    cell.sum += p.cast<double>();
    ++cell.count;
    if constexpr (has_intensity) cell.intensity += cloud.intensity[k];
    if constexpr (has_frames) {
      const float distance = (p - origins[frame[k]]).squaredNorm();
      if (distance < cell.nearest) cell.nearest = distance, cell.frame = frame[k];
    }
    if (has_normals) normals.add(number, cloud.normal(k));
  });

  Thinned result;
  result.cloud.reserve(cells.size());
  for (const Cell& cell : cells) {
    result.cloud.add((cell.sum / cell.count).cast<float>());
    if constexpr (has_intensity)
      result.cloud.intensity.push_back(static_cast<float>(cell.intensity / cell.count));
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
