#pragma once
/// One point per occupied cubic cell: the mean of all that fell into it, of as many clouds as are
/// added.

#include <cstdint>
#include <memory>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::thinning {

/// Takes memory for the occupied cells, not for the points. The same points in the same order give
/// the same means, whether they came as one cloud or as many.
class VoxelMeans {
 public:
  /// Voxels floor(p / edge) of edge length `edge` [m].
  explicit VoxelMeans(double edge);
  ~VoxelMeans();

  /// Adds the points of a cloud. Point k was seen by frame[k] (empty: none is given, and none comes
  /// out), whose sensor stood at origins[frame[k]]. Throws Error when the points are wider than
  /// 2^21 cells along an axis.
  void add(const Cloud& cloud, const std::vector<std::uint16_t>& frame,
           const std::vector<Eigen::Vector3f>& origins);

  struct Result {
    Cloud cloud;  ///< x y z, and intensity and normals where all clouds with points had them
    std::vector<std::uint16_t>
        frame;  ///< of each mean: the frame of that of its points which was seen from nearest
    std::size_t dropped = 0;  ///< points left out because a coordinate is non-finite
  };
  /// The means in the order in which their cells were first met. Sums are double. Normals are
  /// averaged and scaled to length 1; where they cancel out, the cell's first one stands. Asked
  /// once.
  Result take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace plumb::thinning
