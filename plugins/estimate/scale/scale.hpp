#pragma once
/// How large the surroundings are in which a sensor moves, as far as its trajectory tells.

#include "plumb/slam/trajectory.hpp"

namespace plumb::estimate_scale {

/// Median speed [m/s] of the motions between consecutive frames, those at rest (under a tenth of
/// the fastest tenth) left out; 0 where stamps do not grow or nothing moves.
double usual_speed(const Trajectory& trajectory);

/// speed / full_speed, from `min_factor` to 1; 1 for a speed of 0.
double scale_at(double speed, double full_speed, double min_factor);

}  // namespace plumb::estimate_scale
