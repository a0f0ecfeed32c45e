#pragma once
/// Which point pairs are near each other under the present poses.

#include <cstdint>
#include <vector>

#include "plumb/data/graph.hpp"

namespace plumb {

/// Indices of the pairs with |p - T_i_j q| <= max [m], in order.
std::vector<std::uint32_t> closer(const Matches& matches, const Pose& T_i_j, double max);

}  // namespace plumb
