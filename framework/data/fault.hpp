#pragma once
/// What no step may give on a wire: poses and points with numbers that are not finite. Checked by the engine, so that the step that made them is named
/// and not the one that stumbles over them.

#include <cmath>

#include "plumb/data/registration.hpp"

namespace plumb {

inline constexpr const char* pose_not_finite = "a pose with a number that is not finite";
inline constexpr const char* point_not_finite = "a point with a coordinate that is not finite";

inline bool is_finite(const Pose& pose) { return pose.translation.allFinite() && pose.rotation.coeffs().allFinite(); }
inline bool is_finite(const RelativePose& relation) { return is_finite(relation.T_i_j); }
inline bool is_finite(const AbsolutePose& relation) { return is_finite(relation.T_world_i); }
inline bool is_finite(const Eigen::Vector3f& point) { return point.allFinite(); }
template <class T>
bool is_finite(const std::vector<T>& values) {
  for (const T& value : values)
    if (!is_finite(value)) return false;
  return true;
}
inline bool is_finite(const Cloud& cloud) {
  float sum = 0;  // times zero: not a number as soon as one of them is none, and fast
  for (const auto* axis : {&cloud.x, &cloud.y, &cloud.z})
    for (const float value : *axis) sum += value * 0.f;
  return sum == 0;
}

/// "" or what is wrong with a value, whatever step made it. Types that are not listed may hold anything.
template <class T>
const char* fault_in(const T&) { return ""; }
inline const char* fault_in(const Trajectory& trajectory) { return is_finite(trajectory.T_world_frame) ? "" : pose_not_finite; }
inline const char* fault_in(const Poses& poses) { return is_finite(poses.T_world_segment) ? "" : pose_not_finite; }
inline const char* fault_in(const Registration& registration) { return is_finite(registration.T_i_j) ? "" : pose_not_finite; }
inline const char* fault_in(const Range& range) {
  return is_finite(range.T_world_segment) && is_finite(range.T_segment_frame) ? "" : pose_not_finite;
}
inline const char* fault_in(const Relations& relations) {
  return is_finite(relations.relative) && is_finite(relations.absolute) ? "" : pose_not_finite;
}
inline const char* fault_in(const Segment& segment) { return is_finite(segment.cloud) ? "" : point_not_finite; }
inline const char* fault_in(const Matches& matches) { return is_finite(matches.p) && is_finite(matches.q) ? "" : point_not_finite; }

}  // namespace plumb
