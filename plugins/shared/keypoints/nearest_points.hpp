#pragma once
/// Keypoints that another step found, as points of the cloud that is described.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/search_tree.hpp"

namespace plumb::keypoints {

/// The indices of the points in `tree` that are nearest to the `keypoints`, each once, in ascending
/// order. A keypoint that is a point of the cloud gives that point (of equal ones the first).
inline std::vector<std::uint32_t> nearest_points(const SearchTree& tree, const Cloud& keypoints) {
  std::vector<std::uint32_t> result;
  SearchTree::Neighbour nearest;
  for (std::size_t k = 0; k < keypoints.size(); ++k)
    if (tree.nearest(keypoints.point(k), 1, &nearest) == 1) result.push_back(nearest.index);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace plumb::keypoints
