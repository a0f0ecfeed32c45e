#pragma once
/// For tests of steps that prune point pairs: pairs of which it is known which are right.

#include <cmath>
#include <numbers>

#include "plumb/data/random.hpp"
#include "plumb/slam/graph.hpp"

namespace plumb::pcl {

/// Pairs of points within 30 m, `right` of them moved by `T_i_j` and 0.1 m of noise, then `wrong`
/// ones, which lie up to `apart` [m] from where they would be right. index_p counts them.
inline Matches planted(std::uint32_t right, std::uint32_t wrong, const Pose& T_i_j, float apart,
                       std::uint64_t seed) {
  Random random(seed);
  const auto in_box = [&](float half) {
    Eigen::Vector3f v;
    for (int c = 0; c < 3; ++c) v[c] = half * static_cast<float>(2 * random.uniform() - 1);
    return v;
  };
  const auto normal = [&] {
    return std::sqrt(-2 * std::log(1 - random.uniform())) *
           std::cos(2 * std::numbers::pi * random.uniform());
  };
  const Motion motion(T_i_j);
  Matches matches;
  for (std::uint32_t k = 0; k < right + wrong; ++k) {
    const Eigen::Vector3f q = in_box(30);
    Eigen::Vector3f off = in_box(apart);
    if (k < right)
      for (int c = 0; c < 3; ++c) off[c] = static_cast<float>(0.1 * normal());
    matches.p.push_back(motion * q + off);
    matches.q.push_back(q);
    matches.index_p.push_back(k);
    matches.index_q.push_back(k);
    matches.weight.push_back(1);
  }
  matches.found = right + wrong;
  return matches;
}

/// How many of the pairs with these indices are right.
inline std::uint32_t right_of(const std::vector<std::uint32_t>& kept, std::uint32_t right) {
  std::uint32_t count = 0;
  for (const auto k : kept) count += k < right;
  return count;
}

}  // namespace plumb::pcl
