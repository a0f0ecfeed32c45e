#pragma once
/// Which point pairs can be right together.

#include <Eigen/Core>
#include <span>

#include "shared/point_pairs/bit_graph.hpp"

namespace plumb::point_pairs {

/// A rigid motion keeps lengths: pairs a and b of the `chosen` ones are joined where
/// | |p_a - p_b| - |q_a - q_b| | <= tolerance [m] and neither length is below `min_length` [m].
/// Vertex k is pair chosen[k]. Source: lengths as invariants, [Shi2021], [Yang2021].
BitGraph compatibility_of(std::span<const Eigen::Vector3f> p, std::span<const Eigen::Vector3f> q,
                          std::span<const std::uint32_t> chosen, double tolerance,
                          double min_length = 0);

}  // namespace plumb::point_pairs
