#pragma once
/// How well segments agree, on points chosen without regard to what the solver was given.

#include <vector>

#include "plumb/slam/segment.hpp"

namespace plumb::accept_poses {

struct AgreementOptions {
  double max_distance = 1;  ///< [m] a point without a nearer one counts as if it were so far off
  std::uint32_t max_points =
      300;  ///< of i near j, evenly chosen, beginning between those that match.nearest takes
};

/// Points of i that lie in j's box, made wider by max_distance, under either pose: the same ones
/// are then asked under both.
std::vector<std::uint32_t> common_points(const Segment& i, const Segment& j,
                                         const Pose& T_j_i_before, const Pose& T_j_i_after,
                                         const AgreementOptions& options);

/// Mean distance [m] of these points of i from the plane at (without normals: from) their nearest
/// point of j. Negative for no points.
double disagreement(const Segment& i, const Segment& j, const std::vector<std::uint32_t>& points,
                    const Pose& T_j_i, const AgreementOptions& options);

}  // namespace plumb::accept_poses
