#pragma once
/// Point pairs that vote for the same place of segment j in segment i.

#include <cstdint>
#include <vector>

#include "plumb/slam/graph.hpp"

namespace plumb::prune_hough {

struct HoughOptions {
  double hough_bin_size = 1;   ///< [m] edge of a bin; also the bound of the motion's inliers
  double hough_threshold = 5;  ///< votes that a bin must have

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("hough_bin_size", &HoughOptions::hough_bin_size)
        .unit("m")
        .range(0.01, 100)
        .source("PCL, Hough3DGrouping")
        .doc("edge length of the bins that are voted for; also the bound of the motion's inliers");
    is.param("hough_threshold", &HoughOptions::hough_threshold)
        .range(1, 1e6)
        .source("PCL, Hough3DGrouping")
        .doc("votes that a bin must have; a vote is shared out among the eight bins round it");
  }
};

/// A frame at both points of each pair, which should be the same place: its axes are the columns,
/// at p in i's, at q in j's coordinates. Not a number where a point has none.
struct PairFrames {
  std::vector<Eigen::Matrix3f> at_p, at_q;
};

/// The axes of j in either segment under the current poses.
PairFrames frames_of_pose(std::size_t pairs, const Pose& T_i_j);

/// The local reference frames that SHOT uses, of the points of either cloud within `radius` [m].
/// Source: [Tombari2010b]; PCL's SHOTLocalReferenceFrameEstimation.
PairFrames local_frames(const Matches& matches, const Cloud& i, const Cloud& j, double radius);

/// Indices of the pairs, ascending, of the bin with the most pairs that agree with one motion; none
/// if no bin has hough_threshold votes. With c the mean of all q, each pair votes where its frames
/// put c in i: p + at_p at_q' (c - q). The pairs of each bin with more votes than those round it
/// are held against one motion by RANSAC (with a fixed seed). Pairs without frames do not vote.
/// Throws Error where the votes lie too far apart for a dense grid (2^24 bins). Source:
/// [Tombari2010b]; PCL's Hough3DGrouping.
std::vector<std::uint32_t> most_voted(const Matches& matches, const PairFrames& frames,
                                      const HoughOptions& options);

}  // namespace plumb::prune_hough
