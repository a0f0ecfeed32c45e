#pragma once
/// Registers one planar cloud to another by exhaustive search of a window of poses.

#include "plumb/data/cloud.hpp"
#include "shared/planar/correlative_search.hpp"

namespace plumb::register_correlative {

using planar::PlanarPose;

struct CorrelativeOptions {
  double search_window = 0.6;      ///< [m] half width of the window
  double search_angle = 70 * deg;  ///< [rad] half width of the window
  double prior_weight =
      0.1;  ///< score that a pose far from the start loses at most; half of it ...
  double prior_translation_sigma = 0.05;  ///< [m] ... so far off
  double prior_rotation_sigma = 3 * deg;  ///< [rad] ... or turned so far
  double resolution = 0.1;                ///< [m] of the first search
  double sigma = 0.1;                     ///< [m] of the first field
  double retry_below = 0.5;               ///< a score below it is tried again in a window of
  double retry_search_window = 1.5;       ///< [m] ... and all headings
  double fine_resolution = 0.03;          ///< [m] of the second search, round the first's peak
  double fine_sigma = 0.1;                ///< [m]
  double max_range = 30;                  ///< [m] points farther from their sensor are left out
};

struct CorrelativeResult {
  PlanarPose T;         ///< T_target_source
  double score = 0;     ///< of the first search, 0 to 1
  double yaw_step = 0;  ///< [rad] of the second search
  bool retried = false;
};

/// The pose in the window round `start` that registers `source` to `target` best, between the cells
/// of the second search by a parabola. A start that is the identity is no prior (there was no
/// odometry). Score 0 and `start` where either has no points in range.
CorrelativeResult correlate(const Cloud& target, const Cloud& source, const PlanarPose& start,
                            const CorrelativeOptions& options);

}  // namespace plumb::register_correlative
