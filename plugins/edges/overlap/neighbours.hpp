#pragma once
/// Which segments overlap enough to share an edge.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/graph.hpp"
#include "voxels.hpp"

namespace plumb::edges_overlap {

struct OverlapOptions {
  double resolution = 1;  ///< [m]
  /// On the overlap; none: margin x the smallest of consecutive segments.
  std::optional<double> threshold;
  double margin = 0.9;
  double min_threshold = 0.05;  ///< the threshold is never below this
};

struct Neighbourhood {
  Edges edges;               ///< all consecutive pairs, and every other pair above the threshold
  double threshold = 0;      ///< as it was used
  std::size_t compared = 0;  ///< pairs whose boxes meet
  std::vector<std::uint32_t> disconnected;  ///< k: segments k and k+1 do not overlap at all
};

/// Pairs (i, j), i < j, whose boxes come within `margin` [m] of each other, in order; by a sweep
/// along x.
std::vector<std::pair<std::uint32_t, std::uint32_t>> meeting(
    const std::vector<Eigen::AlignedBox3d>& boxes, double margin);

/// `segment(k)` opens segment k (twice, from several threads; nothing but its box and voxels is
/// kept). Consecutive pairs are of kind sequential, the others neighbour; scores are overlaps.
Neighbourhood neighbours(std::size_t count,
                         const std::function<std::shared_ptr<const Segment>(std::size_t)>& segment,
                         const Poses& poses, const OverlapOptions& options, Context& context);

}  // namespace plumb::edges_overlap
