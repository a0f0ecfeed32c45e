#pragma once
/// Which segments overlap enough to share an edge, however overlaps are found.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/graph.hpp"
#include "shared/overlapping/lattice.hpp"

namespace plumb::overlapping {

struct OverlapOptions {
  double resolution = 1;  ///< [m]
  /// On the overlap; none: margin x the smallest of consecutive segments.
  std::optional<double> threshold;
  double margin = 0.9;
  double min_threshold = 0.05;  ///< the threshold is never below this

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("resolution", &OverlapOptions::resolution)
        .unit("m")
        .range(0.01, 100)
        .doc("edge length of the octree's leaves: points in the same leaf overlap");
    is.param("threshold", &OverlapOptions::threshold)
        .unit("%")
        .range(0, 1)
        .doc(
            "pairs that overlap more are neighbours; none: 'margin' x the smallest overlap of "
            "consecutive segments");
    is.param("margin", &OverlapOptions::margin).unit("%").range(0.01, 1).doc("see 'threshold'");
    is.param("min_threshold", &OverlapOptions::min_threshold)
        .unit("%")
        .range(0, 1)
        .doc("lower bound of the threshold, for consecutive segments that hardly overlap");
  }
};

/// How the clouds of segments are held to be compared, and compared. Both are called from several
/// threads, `hold` once for each segment before `overlap` is asked.
struct Comparison {
  /// Holds what is needed of the cloud of segment k.
  std::function<void(std::size_t k, const Cloud& cloud, const Pose& T_world_segment,
                     const Lattice& lattice)>
      hold;
  /// Points of segments i and j in cells that hold points of both / points of both, 0 to 1; may be
  /// 0 where it is not above `least`.
  std::function<double(std::size_t i, std::size_t j, double least)> overlap;
};

struct Neighbourhood {
  Edges edges;               ///< all consecutive pairs, and every other pair above the threshold
  double threshold = 0;      ///< as it was used
  std::size_t compared = 0;  ///< pairs whose boxes meet
  std::vector<std::uint32_t> disconnected;  ///< k: segments k and k+1 do not overlap at all
};

/// Opens segment k; from several threads.
using Opener = std::function<std::shared_ptr<const Segment>(std::size_t)>;

/// Pairs (i, j), i < j, whose boxes come within `margin` [m] of each other, in order; by a sweep
/// along x.
std::vector<std::pair<std::uint32_t, std::uint32_t>> meeting(
    const std::vector<Eigen::AlignedBox3d>& boxes, double margin);

/// `segment(k)` is opened twice (nothing of it is kept but its box). Consecutive pairs are of kind
/// sequential, the others neighbour; scores are overlaps.
Neighbourhood neighbours(std::size_t count, const Opener& segment, const Poses& poses,
                         const OverlapOptions& options, const Comparison& comparison,
                         Context& context);

/// The edges of that, what is to be said of them said through `context`. Throws Error for fewer
/// than two segments, and for poses of others.
Edges propose(std::size_t count, const Opener& segment, const Poses& poses,
              const OverlapOptions& options, const Comparison& comparison, Context& context);

}  // namespace plumb::overlapping
