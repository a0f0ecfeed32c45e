#pragma once
/// Pairs of points that are nearest under the present poses.

#include <cstdint>
#include <optional>

#include "plumb/slam/graph.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::match_nearest {

struct NearestOptions {
  double max_correspondence_distance = 1;  ///< [m] farthest that a pair may be apart
  bool to_plane = false;  ///< residuals along q's normal; segment j must have normals
  std::optional<std::uint32_t> max_points;  ///< of i's points near j, so many at most are asked
  /// [rad] Greatest angle between the normals; both segments must have some.
  std::optional<double> max_normal_angle;
  bool both_ways = false;  ///< half of the points asked are j's, with the nearest of i
};

/// For each point p of segment i the nearest point q of segment j, if |p - T_i_j q| <=
/// max_correspondence_distance; one way only, in the order of i's points. Points of i outside j's
/// box are never asked. With `max_points`, evenly spaced ones of the rest are. Fills p, q, their
/// indices, weights 1, and normal_q when to_plane; `found` counts the pairs before any is dropped
/// for its normals: one that is 0, hence unknown, gives no plane and no angle. Source:
/// [Tang2024] 2.3.2; the plane [Chen1992], the bounds on points and angles are ours.
///
/// With `both_ways` j's points ask as well, half as many each way with `max_points`: what is wrong
/// with the nearest points of one side alone (a cloud is seen from one end of its path, and its
/// normals with it) cancels. Their plane is that at i's point, turned to j by T_i_j (ours).
Matches nearest_pairs(const Segment& i, const Segment& j, const Pose& T_i_j,
                      const NearestOptions& options);

}  // namespace plumb::match_nearest
