#pragma once
/// A motion between two segments made exact by their clouds, and judged by them.

#include "plumb/slam/registration.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::register_features {

struct RefineOptions {
  double initial_max_correspondence_distance =
      2;  ///< [m] farthest that a point and its nearest may be apart in the first iteration
  double max_correspondence_distance = 0.5;  ///< [m] in the last iterations
  std::uint32_t max_iterations = 20;
  std::uint32_t max_points = 2000;  ///< of i, evenly chosen among those in j's box
  double max_normal_angle = 0.8;    ///< [rad] of the points' normals
};

/// Point-to-plane ICP of segment i to segment j, both with normals, from T_j_i. Afterwards
/// `overlap` is the share of i's points in j's box (and of j's in i's, whichever is less) that have
/// a point of the other within max_correspondence_distance with a normal that agrees (that share of
/// the points alone that do not lie on the commonest surfaces, if it is less), `mae` the mean
/// distance to the plane [m], `information` that of T_i_j [1/m^2, 1/rad^2], taking the pairs for as
/// many independent ones as `independent` and their distances for the noise.
Registration refined(const Segment& i, const Segment& j, const Pose& T_j_i,
                     const RefineOptions& options, double independent = 50);

}  // namespace plumb::register_features
