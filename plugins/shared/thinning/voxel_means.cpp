#include "shared/thinning/voxel_means.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "plumb/data/error.hpp"
#include "plumb/data/short_number.hpp"
#include "shared/thinning/cell_table.hpp"

namespace plumb::thinning {
namespace {

constexpr double most_cells = 1 << 21;

bool all_finite(const std::vector<float>& values) {
  std::uint32_t special = 0;
  for (const float v : values)
    special += (std::bit_cast<std::uint32_t>(v) & 0x7f800000u) == 0x7f800000u;
  return special == 0;
}

/// What a cell gathers: one line of the cache.
struct alignas(64) Cell {
  std::uint64_t key;
  double x, y, z, intensity;
  float nearest;  ///< squared distance from which it was seen [m^2]; looked at from the second
                  ///< point on
  std::uint32_t count;
  std::uint16_t frame;
};

/// Numbers the cells along one axis. The first points lie in the middle of what can be numbered.
class Axis {
 public:
  Axis(double edge, const char* name) : per_metre_(1 / edge), edge_(edge), name_(name) {}

  /// Room for more coordinates. Throws Error when there is none.
  void reach(const std::vector<float>& values) {
    float least = least_, greatest = greatest_;
    for (const float value : values) {
      least = value < least ? value : least;
      greatest = value > greatest ? value : greatest;
    }
    const double lowest = std::floor(least * per_metre_),
                 highest = std::floor(greatest * per_metre_);
    if (least_ > greatest_) low_ = std::floor((lowest + highest + 1) / 2) - most_cells / 2;
    if (lowest < low_ || highest >= low_ + most_cells)
      throw Error(std::string("the cloud reaches from ") + short_number(least) + " m to " +
                  short_number(greatest) + " m along " + name_ +
                  ", which is more than 2^21 voxels of " + short_number(edge_) +
                  " m: drop far points before, or take larger voxels");
    least_ = least, greatest_ = greatest;
  }
  void cells(const std::vector<float>& values, std::size_t first, std::size_t n,
             std::uint32_t* to) const {
    for (std::size_t k = 0; k < n; ++k)
      to[k] = static_cast<std::uint32_t>(
          static_cast<std::int32_t>(std::floor(values[first + k] * per_metre_) - low_));
  }

 private:
  double per_metre_, edge_;
  const char* name_;
  double low_ = 0;
  float least_ = std::numeric_limits<float>::infinity(),
        greatest_ = -std::numeric_limits<float>::infinity();
};

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

}  // namespace

struct VoxelMeans::State {
  explicit State(double edge) : x(edge, "x"), y(edge, "y"), z(edge, "z") {}

  Axis x, y, z;
  CellTable<Cell> cells;
  Normals normals;
  bool intensity = true, frames = true, has_normals = true;  ///< as long as all had them
  std::size_t dropped = 0;

  /// `cloud` has finite points only.
  template <bool with_intensity, bool with_frames>
  void add(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
           const std::vector<Eigen::Vector3f>& origins) {
    x.reach(cloud.x), y.reach(cloud.y), z.reach(cloud.z);
    const auto add_point = [&](std::size_t k, Cell& cell) {
      cell.x += cloud.x[k];
      cell.y += cloud.y[k];
      cell.z += cloud.z[k];
      if constexpr (with_intensity) cell.intensity += cloud.intensity[k];
      if constexpr (with_frames) {
        const float distance = (cloud.point(k) - origins[frame[k]]).squaredNorm();
        if (cell.count == 0 || distance < cell.nearest)
          cell.nearest = distance, cell.frame = frame[k];
      }
      ++cell.count;
    };
    constexpr std::size_t batch = CellTable<Cell>::batch;
    std::uint64_t keys[batch];
    std::uint32_t cx[batch], cy[batch], cz[batch], numbers[batch];
    for (std::size_t first = 0; first < cloud.size(); first += batch) {
      const std::size_t n = std::min(batch, cloud.size() - first);
      x.cells(cloud.x, first, n, cx);
      y.cells(cloud.y, first, n, cy);
      z.cells(cloud.z, first, n, cz);
      for (std::size_t k = 0; k < n; ++k)
        keys[k] = std::uint64_t{cx[k]} << 42 | std::uint64_t{cy[k]} << 21 | cz[k];
      cells.find(keys, n, numbers);
      for (std::size_t k = 0; k < n; ++k) add_point(first + k, cells[numbers[k]]);
      if (has_normals)
        for (std::size_t k = 0; k < n; ++k) normals.add(numbers[k], cloud.normal(first + k));
    }
  }

  void add_finite(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
                  const std::vector<Eigen::Vector3f>& origins) {
    if (cloud.empty()) return;
    intensity = intensity && cloud.intensity.size() == cloud.size();
    frames = frames && frame.size() == cloud.size();
    has_normals = has_normals && cloud.has_normals();
    if (!has_normals) normals = {};
    if (frames)
      intensity ? add<true, true>(cloud, frame, origins) : add<false, true>(cloud, frame, origins);
    else
      intensity ? add<true, false>(cloud, frame, origins)
                : add<false, false>(cloud, frame, origins);
  }
};

VoxelMeans::VoxelMeans(double edge) : state_(std::make_unique<State>(edge)) {}
VoxelMeans::~VoxelMeans() = default;

void VoxelMeans::add(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
                     const std::vector<Eigen::Vector3f>& origins) {
  if (all_finite(cloud.x) && all_finite(cloud.y) && all_finite(cloud.z))
    return state_->add_finite(cloud, frame, origins);
  std::vector<std::uint32_t> finite;
  std::vector<std::uint16_t> their_frames;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (!cloud.point(k).allFinite()) continue;
    finite.push_back(static_cast<std::uint32_t>(k));
    if (!frame.empty()) their_frames.push_back(frame[k]);
  }
  state_->dropped += cloud.size() - finite.size();
  state_->add_finite(select(cloud, finite), their_frames, origins);
}

VoxelMeans::Result VoxelMeans::take() {
  Result result;
  result.dropped = state_->dropped;
  auto& cells = state_->cells;
  const std::uint32_t count = cells.count();
  const bool intensity = state_->intensity, frames = state_->frames;
  result.cloud.reserve(count);
  if (intensity) result.cloud.intensity.reserve(count);
  if (frames) result.frame.reserve(count);
  cells.take([&](const Cell& cell) {
    const double share = 1.0 / cell.count;
    result.cloud.add(Eigen::Vector3d(share * cell.x, share * cell.y, share * cell.z).cast<float>());
    if (intensity) result.cloud.intensity.push_back(static_cast<float>(share * cell.intensity));
    if (frames) result.frame.push_back(cell.frame);
  });
  state_->normals.write(result.cloud);
  return result;
}

}  // namespace plumb::thinning
