#pragma once
/// Rigid motion that aligns one set of points with another.

#include <span>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// The rigid motion T_b_a that makes the sum of |T_b_a * a[k] - b[k]|^2 least, over points that
/// correspond by index (equally many). It never mirrors, not even where a mirror image would fit
/// better. Points that leave it open (fewer than three, or on a line) get one of the best motions;
/// none at all gives the identity. Source: Umeyama 1991, with scale 1.
Pose align(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b);

}  // namespace plumb
