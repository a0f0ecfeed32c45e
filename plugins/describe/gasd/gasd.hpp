#pragma once
/// Globally aligned spatial distribution: where the points of a cloud lie in the box of its own
/// principal axes, 512 numbers.

#include <optional>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::describe_gasd {

inline constexpr std::size_t gasd_side = 8;  ///< cells along an axis
inline constexpr std::size_t gasd_size = gasd_side * gasd_side * gasd_side;

/// How a point is counted.
enum class Interpolation {
  none,         ///< in its cell
  quadrilinear  ///< shared out among the cells round it
};

/// The GASD of `cloud` (finite points); the numbers sum to 1. The cloud is turned to its principal
/// axes: z is that of the least spread, downwards in the cloud's coordinates, x that of the widest,
/// to the side with the longer tail (the sum of the cubes of x is positive). Number (i * 8 + j) * 8
/// + k is the share of the points in cell (i, j, k) of the cube about the centroid that just holds
/// them. Nothing if the points have no extent, or fewer than three are there. Source: [Lima2016];
/// PCL's GASDEstimation, which leaves the sign of x open.
std::optional<std::vector<float>> gasd(const Cloud& cloud, Interpolation interpolation);

}  // namespace plumb::describe_gasd
