#pragma once
/// Pairs of keypoints as matches.

#include <cstdint>
#include <utility>
#include <vector>

#include "plumb/slam/values.hpp"

namespace plumb::feature_space {

/// Keypoint i of one segment and keypoint j of another.
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Throws Error where the two are described by vectors of different length.
void require_one_dimension(const Features& of_i, const Features& of_j);

/// The pairs' points, places, weight 1, normals where both sides have them, and whether either
/// point lies at its cloud's border.
Matches paired(const Features& of_i, const Features& of_j, const Pairs& pairs);

}  // namespace plumb::feature_space
