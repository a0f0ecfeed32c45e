#pragma once
/// The neighbours of one point of a cloud after another.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/search_tree.hpp"

namespace plumb::neighbourhood {

/// Which points count as neighbours of a point, itself included: the `most` nearest of those within
/// `radius` [m]. Either may be left open, not both.
struct Bounds {
  std::optional<double> radius;
  std::optional<std::uint32_t> most;
};

/// Finds them, in memory of its own: one for each thread. Cloud and tree, which holds the cloud's
/// points, outlive it.
class Finder {
 public:
  Finder(const Cloud& cloud, const SearchTree& tree, const Bounds& bounds);

  /// Neighbours of point k as seen from there; none of a point with a non-finite coordinate. Until
  /// the next question.
  const std::vector<Eigen::Vector3f>& around(std::size_t k);

 private:
  const Cloud& cloud_;
  const SearchTree& tree_;
  Bounds bounds_;
  std::vector<SearchTree::Neighbour> found_;
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace plumb::neighbourhood
