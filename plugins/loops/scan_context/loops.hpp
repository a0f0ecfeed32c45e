#pragma once
/// Which segments show a place that was seen before, by their scan contexts.

#include <functional>
#include <optional>
#include <vector>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/graph.hpp"
#include "scan_context.hpp"

namespace plumb::loops_scan_context {

struct LoopOptions {
  std::uint32_t candidates = 10;
  std::optional<double> min_path_separation;  ///< [m] none: 4 x the median step
  std::optional<double> threshold;            ///< none: as follows
  double stddev_mul_thresh = 3.5;
  std::optional<double> drift;  ///< share of the path; none: poses do not limit the search
  std::uint32_t loops_per_segment = 1;

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("candidates", &LoopOptions::candidates)
        .range(1, 1000)
        .doc("segments with the most similar ring keys that are compared by their whole contexts")
        .source("[Kim2018] III.D");
    is.param("min_path_separation", &LoopOptions::min_path_separation)
        .unit("m")
        .range(0, 1e6)
        .doc("path between two visits; none: 4 x the median distance of consecutive segments");
    is.param("threshold", &LoopOptions::threshold)
        .range(0, 1)
        .doc("least similarity; none: from the similarities of all pairs, by stddev_mul_thresh");
    is.param("stddev_mul_thresh", &LoopOptions::stddev_mul_thresh)
        .range(0, 100)
        .doc(
            "the threshold is the median similarity of segments that lie apart along the path, and "
            "so many of its standard deviations more");
    is.param("drift", &LoopOptions::drift)
        .unit("%")
        .range(0, 10)
        .doc(
            "expected drift, as a share of the path between two visits: partners are at most this, "
            "and twice the median distance of consecutive segments, apart; none: anywhere");
    is.param("loops_per_segment", &LoopOptions::loops_per_segment)
        .range(1, 1000)
        .doc("most similar partners that a segment may have");
  }
};

/// What is known of each segment, in their order.
struct Place {
  ScanContext context;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of its frame, world [m]
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of its cloud, world [m]
};

struct Loops {
  Edges edges;                                    ///< kind loop, scores are similarities
  double threshold = 0, min_path_separation = 0;  ///< as they were used
};

/// For each segment those that lie min_path_separation of path away (and near enough, where drift
/// is given) are put in order of how alike their ring keys are; of the first `candidates` of them
/// the most similar ones above the threshold are its partners. The standard deviation is told by
/// the median absolute deviation, of at most 20,000 pairs, evenly chosen. Source: [Kim2018]; the
/// threshold, separation and drift are ours.
Loops find_loops(const std::vector<Place>& places, const LoopOptions& options, Context& context);

}  // namespace plumb::loops_scan_context
