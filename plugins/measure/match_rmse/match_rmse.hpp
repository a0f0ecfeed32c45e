#pragma once
/// How well the clouds of an edge's two segments agree.

#include <optional>
#include <utility>
#include <vector>

#include "plumb/slam/segment.hpp"

namespace plumb::measure_match_rmse {

/// Pairs of nearest points: indices into i's and j's clouds.
using IndexPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// For every point of `i` its nearest of `j` under `T_j_i`, if nearer than
/// `max_correspondence_distance` [m]. With `max_points` only every n-th point of i is asked, n the
/// smallest that keeps them to that number.
IndexPairs nearest_pairs(const Segment& i, const Segment& j, const Pose& T_j_i,
                         double max_correspondence_distance,
                         std::optional<std::uint32_t> max_points);

/// Root of the mean squared distance [m] of the pairs under `T_j_i`; NaN for no pairs. Source:
/// [Tang2024] eq. 3.
double rmse_of(const IndexPairs& pairs, const Segment& i, const Segment& j, const Pose& T_j_i);

}  // namespace plumb::measure_match_rmse
