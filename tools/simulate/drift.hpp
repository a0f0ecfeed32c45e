#pragma once
/// What an odometry makes of a true path.

#include <cstdint>
#include <functional>

#include "plumb/slam/trajectory.hpp"

namespace plumb::simulate {

/// Greatest distance [m] between poses of the same index, the first two aligned.
double drift_of(const Trajectory& odometry, const Trajectory& truth);

/// The factor (of errors that grow with it) at which `reached(factor)` comes to `drift` [m]. Throws
/// Error where none does.
double factor_that_reaches(double drift, const std::function<double(double)>& reached);

/// `truth` with slow drift: turning errors about all axes and an error of scale, each a first-order
/// Gauss-Markov process along the path (100 m until it forgets itself), all scaled by one factor so
/// that drift_of is `drift` [m]. First pose and stamps are the truth's.
Trajectory drifted(const Trajectory& truth, double drift, std::uint64_t seed);

/// `truth` with the errors that `odometry` made on `odometry_truth`, step by step, applied to it by
/// travelled distance; a longer path meets them again from the start. On the same path the odometry
/// itself comes out, save for a first pose that is no longer off. Throws Error where the two differ
/// in length or go nowhere.
Trajectory transplanted(const Trajectory& truth, const Trajectory& odometry,
                        const Trajectory& odometry_truth);

}  // namespace plumb::simulate
