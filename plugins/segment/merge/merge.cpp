#include "merge.hpp"

#include <algorithm>

#include "shared/thinning/voxel_means.hpp"

namespace plumb::segment_merge {
namespace {

/// to[k] = row * (x, y, z)[k] + shift.
void move_axis(const Eigen::RowVector3f& row, float shift, const std::vector<float>& x,
               const std::vector<float>& y, const std::vector<float>& z, float* to) {
  const float a = row.x(), b = row.y(), c = row.z();
  for (std::size_t k = 0; k < x.size(); ++k) to[k] = a * x[k] + b * y[k] + c * z[k] + shift;
}

/// An array that every frame must have, or it is dropped for good.
template <class T>
struct Optional {
  std::vector<T>& to;
  bool kept = true;

  /// Room for the `n` points of a frame which has the array if `has`; null if the array is dropped.
  T* grow(bool has, std::size_t n) {
    if (kept && !has) to = {}, kept = false;
    if (!kept) return nullptr;
    to.resize(to.size() + n);
    return to.data() + to.size() - n;
  }
  void append(const std::vector<T>& from, std::size_t n) {
    if (T* at = grow(from.size() == n, n)) std::copy(from.begin(), from.end(), at);
  }
};

/// The segment's cloud in the making.
struct Merger {
  Cloud cloud;
  std::vector<std::uint16_t> frame;
  Optional<float> intensity{cloud.intensity}, time{cloud.time};
  Optional<std::uint16_t> ring{cloud.ring};
  Optional<float> nx{cloud.nx}, ny{cloud.ny}, nz{cloud.nz};

  /// Room for `n` points, with the arrays that `like` has.
  void reserve(std::size_t n, const Cloud& like) {
    cloud.reserve(n);
    frame.reserve(n);
    if (!like.intensity.empty()) cloud.intensity.reserve(n);
    if (!like.time.empty()) cloud.time.reserve(n);
    if (!like.ring.empty()) cloud.ring.reserve(n);
    if (like.has_normals())
      for (auto* array : {&cloud.nx, &cloud.ny, &cloud.nz}) array->reserve(n);
  }

  void add(const Cloud& from, const Pose& T_segment_frame, std::uint16_t number) {
    const Motion motion(T_segment_frame);
    const std::size_t n = from.size(), before = cloud.size();
    std::vector<float>* const axes[] = {&cloud.x, &cloud.y, &cloud.z};
    Optional<float>* const normals[] = {&nx, &ny, &nz};
    for (int axis = 0; axis < 3; ++axis) {
      axes[axis]->resize(before + n);
      move_axis(motion.r.row(axis), motion.t[axis], from.x, from.y, from.z,
                axes[axis]->data() + before);
      if (float* at = normals[axis]->grow(from.has_normals(), n))
        move_axis(motion.r.row(axis), 0, from.nx, from.ny, from.nz, at);
    }
    intensity.append(from.intensity, n);
    time.append(from.time, n);
    ring.append(from.ring, n);
    frame.resize(before + n, number);
  }
};

}  // namespace

Segment merge(const FrameRange& range, const OpenFrame& open) {
  Merger merger;
  for (std::size_t k = 0; k < range.size(); ++k) {
    const auto frame = open(k);
    const Cloud& cloud = frame->cloud;
    if (cloud.empty()) continue;
    // Frames of one sensor are about equally large: room for all at the first one, and a tenth
    // more.
    if (merger.cloud.empty()) merger.reserve((range.size() - k) * cloud.size() * 11 / 10, cloud);
    merger.add(cloud, range.T_segment_frame[k], static_cast<std::uint16_t>(k));
  }
  Segment empty;
  empty.range = range;
  return empty.with(std::move(merger.cloud), std::move(merger.frame));
}

Segment merge_thinned(const FrameRange& range, double voxel_size, const OpenFrame& open,
                      std::size_t& dropped) {
  thinning::VoxelMeans means(voxel_size);
  const auto origins = range.origins();
  for (std::size_t k = 0; k < range.size(); ++k) {
    Merger moved;
    moved.add(open(k)->cloud, range.T_segment_frame[k], static_cast<std::uint16_t>(k));
    means.add(moved.cloud, moved.frame, origins);
  }
  auto thinned = means.take();
  dropped = thinned.dropped;
  Segment empty;
  empty.range = range;
  return empty.with(std::move(thinned.cloud), std::move(thinned.frame));
}

}  // namespace plumb::segment_merge
