#pragma once
/// Numbers that a reader must not let through; a rotation is one of norm 1.

#include <algorithm>
#include <cmath>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

inline bool is_finite(const Pose& pose) {
  return pose.translation.allFinite() && std::abs(pose.rotation.norm() - 1) < 1e-6;
}
inline bool is_finite(const std::vector<Pose>& poses) {
  return std::ranges::all_of(poses, [](const Pose& pose) { return is_finite(pose); });
}
inline bool is_finite(const Cloud& cloud) {
  const auto all = [](const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
  };
  return all(cloud.x) && all(cloud.y) && all(cloud.z);
}

}  // namespace plumb
