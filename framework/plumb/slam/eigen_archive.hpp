#pragma once
/// Eigen's vectors and matrices of fixed size, and poses, as fields of values.

#include <Eigen/Core>

#include "plumb/data/archive.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// Without padding: their bytes are their value.
template <class S, int R, int C, int O, int MR, int MC>
inline constexpr bool is_plain<Eigen::Matrix<S, R, C, O, MR, MC>> =
    R != Eigen::Dynamic&& C != Eigen::Dynamic;

/// Rotation x, y, z, w, then translation [m].
template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Pose>
void fields(Archive& a, T& p) {
  a(p.rotation.x(), p.rotation.y(), p.rotation.z(), p.rotation.w(), p.translation.x(),
    p.translation.y(), p.translation.z());
}

}  // namespace plumb
