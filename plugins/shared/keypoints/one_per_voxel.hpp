#pragma once
/// Keypoints without a detector: of each voxel the point in its middle, or all points.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::keypoints {

/// Whether a point may be one: it has a finite position and a normal.
inline bool counts(const Cloud& cloud, std::size_t k) {
  const Eigen::Vector3f normal = cloud.normal(k);
  return cloud.point(k).allFinite() && normal.allFinite() && !normal.isZero();
}

/// Every point that may be one, in ascending order of index.
inline std::vector<std::uint32_t> all_points(const Cloud& cloud) {
  std::vector<std::uint32_t> result;
  if (!cloud.has_normals()) return result;
  for (std::size_t k = 0; k < cloud.size(); ++k)
    if (counts(cloud, k)) result.push_back(static_cast<std::uint32_t>(k));
  return result;
}

/// Of each cubic cell of edge `voxel_size` [m] the point nearest to the mean of the cell's points,
/// in ascending order of index. Points without a finite position or without a normal do not count.
/// Of two that are equally near the one with the lower index is taken.
inline std::vector<std::uint32_t> one_per_voxel(const Cloud& cloud, double voxel_size) {
  struct InCell {
    std::array<std::int64_t, 3> cell;
    std::uint32_t index;
    auto operator<=>(const InCell&) const = default;
  };
  std::vector<std::uint32_t> result;
  if (!cloud.has_normals()) return result;
  std::vector<InCell> points;
  points.reserve(cloud.size());
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    if (!counts(cloud, k)) continue;
    const Eigen::Vector3d at = cloud.point(k).cast<double>() / voxel_size;
    const auto cell = [&](int c) { return static_cast<std::int64_t>(std::floor(at[c])); };
    points.push_back({{cell(0), cell(1), cell(2)}, static_cast<std::uint32_t>(k)});
  }
  std::sort(points.begin(), points.end());
  for (std::size_t first = 0, end = 0; first < points.size(); first = end) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (; end < points.size() && points[end].cell == points[first].cell; ++end)
      mean += cloud.point(points[end].index).cast<double>();
    mean /= static_cast<double>(end - first);
    const auto off = [&](std::size_t k) {
      return (cloud.point(points[k].index).cast<double>() - mean).squaredNorm();
    };
    std::size_t best = first;
    for (std::size_t k = first + 1; k < end; ++k)
      if (off(k) < off(best)) best = k;
    result.push_back(points[best].index);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace plumb::keypoints
