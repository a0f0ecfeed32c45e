#pragma once
/// How far a trajectory goes astray along the world's axes.

#include "plumb/slam/trajectory_error.hpp"

namespace plumb::measure_trajectory {

/// Mean absolute error [m] of the positions along the truth's x and y when the first pair's poses
/// are aligned: what a robot is off that starts at a known place. NaN for no pairs.
/// Source: [Zhang2023] 3, "mean displacement error".
Eigen::Vector2d mean_displacement(const PosePairs& pairs);

}  // namespace plumb::measure_trajectory
