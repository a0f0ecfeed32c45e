#pragma once
/// Point pairs that share no point.

#include <cstdint>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::prune_one_to_one {

/// Indices of pairs no two of which have a point in common, ascending: of the pairs with one point
/// of segment j (`index_q`) the one is kept whose points lie closest under `T_i_j`, then of those
/// left with one point of segment i (`index_p`) the same. Throws Error where the pairs do not name
/// their points. Source: PCL's CorrespondenceRejectorOneToOne, once for each end.
std::vector<std::uint32_t> one_to_one(const Matches& matches, const Pose& T_i_j);

}  // namespace plumb::prune_one_to_one
