#pragma once
/// The rigid motion that point pairs say, and which pairs agree with a motion.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb::point_pairs {

/// The motion T_to_from with the least sum of |T from_k - to_k|^2 over the given pairs (three or
/// more, not in a line). weights[n], if given, multiplies the square of pairs[n]; their sum is
/// positive. Source: [Kabsch1976], [Umeyama1991] without scale.
Pose rigid_fit(std::span<const Eigen::Vector3f> from, std::span<const Eigen::Vector3f> to,
               std::span<const std::uint32_t> pairs, std::span<const double> weights = {});

/// Indices of the pairs with |T_to_from from_k - to_k| <= max [m], in order; compared as squares in
/// float.
std::vector<std::uint32_t> agreeing(std::span<const Eigen::Vector3f> from,
                                    std::span<const Eigen::Vector3f> to, const Pose& T_to_from,
                                    double max);

}  // namespace plumb::point_pairs
