#pragma once
/// Which segments show a place that was seen before.

#include <functional>
#include <optional>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::loops_descriptor {

/// World coordinates [m] of each segment, under poses that may have drifted.
struct Places {
  std::vector<Eigen::Vector3d> positions;  ///< of its frame; the path runs through these
  std::vector<Eigen::Vector3d> centroids;  ///< of its cloud
};

/// In metres, ratios and similarities from 0 to 1. The step is the distance from one segment to
/// the next.
struct LoopOptions {
  std::uint32_t candidates = 3;
  std::optional<double> min_path_separation;    ///< none: 4 x the median step
  std::optional<double> max_centroid_distance;  ///< none: 2 x the median step
  double drift = 0.03;
  std::optional<double> threshold;  ///< none: relative, as follows
  double relative_threshold = 0.7;
  std::uint32_t loops_per_segment = 2;
  std::uint32_t stride = 1;                ///< segments from one pair of a walk to the next
  std::optional<std::uint32_t> max_walks;  ///< none: as many as find something
  bool either_direction = true;            ///< false: (i + stride, j + stride) alone

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("candidates", &LoopOptions::candidates)
        .range(1, 1000)
        .doc("number of nearest centroids that are compared by similarity")
        .source("[Tang2024] 2.3.1");
    is.param("min_path_separation", &LoopOptions::min_path_separation)
        .unit("m")
        .range(0, 1e6)
        .doc("path between two visits; none: 4 x the median distance of consecutive segments");
    is.param("max_centroid_distance", &LoopOptions::max_centroid_distance)
        .unit("m")
        .range(0, 1e6)
        .doc(
            "distance of the centroids without drift; none: 2 x the median distance of consecutive "
            "segments");
    is.param("drift", &LoopOptions::drift)
        .unit("%")
        .range(0, 1)
        .doc(
            "expected drift, as a share of the path between two visits; added to "
            "'max_centroid_distance'");
    is.param("threshold", &LoopOptions::threshold)
        .range(0, 1)
        .doc(
            "least similarity; none: 'relative_threshold' x the median similarity of consecutive "
            "segments");
    is.param("relative_threshold", &LoopOptions::relative_threshold)
        .unit("%")
        .range(0, 10)
        .doc("see 'threshold'");
    is.param("loops_per_segment", &LoopOptions::loops_per_segment)
        .range(1, 1000)
        .doc("edges are added until both ends have this many");
    is.param("stride", &LoopOptions::stride)
        .range(1, 1000)
        .doc(
            "segments from one pair of a walk to the next: after (i, j) come (i + stride, j + "
            "stride) and (i - stride, j - stride)")
        .source("[Tang2024] 2.3.1 names (i - 2, j - 2)");
    is.param("max_walks", &LoopOptions::max_walks)
        .range(1, 1e9)
        .doc(
            "walks that are begun, the first one from the most similar pair of all; none: as long "
            "as a pair is left that has an end with too few edges");
    is.param("either_direction", &LoopOptions::either_direction)
        .doc(
            "walk to (i + stride, j - stride) where that is more similar, as along a street driven "
            "back; false: i and j always rise together");
  }
};

struct Loops {
  Edges edges;  ///< kind loop, scores are similarities
  double threshold = 0, min_path_separation = 0, max_centroid_distance = 0;  ///< as they were used
  std::size_t walks = 0;  ///< loops that were begun
};

/// `alike(i, j)` is the similarity of two segments, 0 to 1, symmetric.
///
/// For each segment, those of its `candidates` nearest centroids that are most similar are its
/// partners. A partner lies at least min_path_separation along the path away, is not next in order,
/// and is not farther than max_centroid_distance + drift x the path between. The most similar pair
/// (i, j) of all is the first edge; from it edges are added to both sides, (i-1, j-1), (i+1, j+1),
/// ... or (i-1, j+1), (i+1, j-1), ..., whichever way has the greater sum of similarities, until the
/// threshold or what a partner may be is not met. Then the same from the most similar pair that is
/// left and has an end with too few edges. So there are at most loops_per_segment x segments edges.
/// With a `stride` the walk goes from (i, j) to (i-stride, j-stride) and so on, and after
/// `max_walks` no further one is begun. Source: [Tang2024] 2.3.1 and its figure 1, whose text names
/// of the walk only that it ends where (i-2, j-2) is below the threshold. How near and how far
/// along the path a partner must be, the relative threshold, further partners, the second way and
/// the later walks are ours.
Loops find_loops(const Places& places,
                 const std::function<double(std::uint32_t, std::uint32_t)>& alike,
                 const LoopOptions& options);

}  // namespace plumb::loops_descriptor
