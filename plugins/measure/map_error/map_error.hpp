#pragma once
/// How far the walls of a map are from the true ones.

#include "floor_plan.hpp"
#include "plumb/slam/trajectory_error.hpp"
#include "plumb/slam/values.hpp"
#include "shared/parallel/loop.hpp"
#include "shared/planar/planar_pose.hpp"

namespace plumb::measure_map_error {

using planar::PlanarPose;

/// Aligns the estimated positions with the true ones, x and y only, with the least sum of squares;
/// where they all lie at one place (within a millimetre) the mean difference of the headings gives
/// the angle. The identity for no pairs.
PlanarPose planar_alignment(const PosePairs& pairs);

struct MapError {
  std::size_t occupied = 0;  ///< cells
  double mean = 0, rms = 0, largest = 0,
         percentile_99 = 0;  ///< distance of an occupied cell's centre to the nearest wall [m]
  double accuracy = 0;       ///< share of occupied cells nearer than `max_wall_distance`
  double coverage =
      0;  ///< share of the walls' length that has an occupied cell nearer than `max_wall_distance`
};

/// Compares the cells whose log odds are above `threshold`, moved by `T_plan_map`, with the walls.
/// NaN for no such cell.
MapError map_error(const GridMap& map, const std::vector<Wall>& walls, const PlanarPose& T_plan_map,
                   float threshold, double max_wall_distance, const parallel::Loop& parallel);

}  // namespace plumb::measure_map_error
