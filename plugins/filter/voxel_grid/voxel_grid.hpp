#pragma once
/// Thins a cloud to one point per occupied cubic cell.

#include <cstdint>
#include <vector>

#include "plumb/data/segment.hpp"

namespace plumb {

struct Thinned {
  Cloud cloud;  ///< the cells' means: x y z, intensity and normals where the cloud has them
  std::vector<std::uint16_t>
      frame;  ///< of each mean: the frame of that of its points which was seen from nearest
  std::size_t dropped = 0;  ///< points left out because a coordinate is no finite number
};

/// The mean of the points in each occupied cell floor(p / leaf), `leaf` [m], in the order in which
/// the cells are first met. Sums are double. Normals are averaged and scaled to length 1; where
/// they cancel out, the cell's first one stands. Point k was seen by frame[k] (empty: none is
/// given, and none comes out), whose sensor stood at origins[frame[k]]. Throws Error when the cloud
/// is wider than 2^21 cells along an axis.
Thinned thin(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
             const std::vector<Eigen::Vector3f>& origins, double leaf);

/// The same for a segment.
Thinned thin(const Segment& segment, double leaf);

}  // namespace plumb
