#pragma once
/// Registers one planar cloud to another by exhaustive search of a window of poses.

#include "plumb/slam/cloud.hpp"
#include "shared/planar/correlative_search.hpp"

namespace plumb::register_correlative {

using planar::PlanarPose;

struct CorrelativeOptions {
  double search_window = 0.6;             ///< [m]
  double search_angle = 70 * deg;         ///< [rad]
  double prior_weight = 0.1;              ///< half of it is lost ...
  double prior_translation_sigma = 0.05;  ///< [m] ... so far off
  double prior_rotation_sigma = 3 * deg;  ///< [rad] ... or turned so far
  double resolution = 0.1;                ///< [m] of the first search
  double sigma = 0.1;                     ///< [m] of the first field
  double retry_below = 0.5;               ///< score
  double retry_search_window = 1.5;       ///< [m]
  double fine_resolution = 0.03;          ///< [m] of the second search, round the first's peak
  double fine_sigma = 0.1;                ///< [m]
  double max_range = 30;                  ///< [m]

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("search_window", &CorrelativeOptions::search_window)
        .unit("m")
        .range(0.01, 20)
        .doc("half width of the window in x and y");
    is.param("search_angle", &CorrelativeOptions::search_angle)
        .unit("rad")
        .range(0.05 * deg, 180 * deg)
        .doc("half width of the window in heading");
    is.param("prior_weight", &CorrelativeOptions::prior_weight)
        .range(0, 1)
        .doc(
            "score that a pose far from the current one loses at most, so that the current pose "
            "decides where the points do not, as along a corridor; no effect where the current "
            "pose is the identity");
    is.param("prior_translation_sigma", &CorrelativeOptions::prior_translation_sigma)
        .unit("m")
        .range(1e-3, 10)
        .doc("translation at which half of it is lost");
    is.param("prior_rotation_sigma", &CorrelativeOptions::prior_rotation_sigma)
        .unit("rad")
        .range(0.05 * deg, 180 * deg)
        .doc("rotation at which half of it is lost");
    is.param("resolution", &CorrelativeOptions::resolution)
        .unit("m")
        .range(0.01, 2)
        .doc("edge length of a cell of the first search");
    is.param("sigma", &CorrelativeOptions::sigma)
        .unit("m")
        .range(0.005, 2)
        .doc("standard deviation of a point's position in the first search");
    is.param("retry_below", &CorrelativeOptions::retry_below)
        .range(0, 1)
        .doc(
            "where the best score is lower, the window is widened to retry_search_window and all "
            "headings");
    is.param("retry_search_window", &CorrelativeOptions::retry_search_window)
        .unit("m")
        .range(0.01, 50)
        .doc("see retry_below");
    is.param("fine_resolution", &CorrelativeOptions::fine_resolution)
        .unit("m")
        .range(0.005, 1)
        .doc("edge length of a cell of the second search, around the peak of the first");
    is.param("fine_sigma", &CorrelativeOptions::fine_sigma)
        .unit("m")
        .range(0.005, 1)
        .doc("standard deviation of a point's position in the second search");
    is.param("max_range", &CorrelativeOptions::max_range)
        .unit("m")
        .range(1, 1000)
        .doc("points farther from their sensor are left out");
  }
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
