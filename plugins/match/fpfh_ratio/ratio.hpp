#pragma once
/// Matches that are distinctive: nearest in feature space, and by far.

#include "shared/feature_space/paired.hpp"

namespace plumb::match_fpfh_ratio {

struct RatioOptions {
  double ratio = 0.8;           ///< of the distances to the nearest and to the second
  double min_separation = 2.5;  ///< [m] in space, of the second from the nearest
  bool mutual = true;

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("ratio", &RatioOptions::ratio)
        .unit("%")
        .range(0.01, 1)
        .doc(
            "a match is kept if its distance in feature space is less than this share of the "
            "distance to the second nearest keypoint")
        .source("[Lowe2004] 7.1");
    is.param("min_separation", &RatioOptions::min_separation)
        .unit("m")
        .range(0, 1000)
        .doc(
            "the second nearest keypoint is sought among those at least so far from the nearest "
            "one in space: nearer ones show the same surface");
    is.param("mutual", &RatioOptions::mutual)
        .doc("the test must hold from the second segment to the first as well");
  }
};

/// Pairs (i, j) in ascending order of i such that b_j is the nearest to a_i in feature space, and
/// nearer than `ratio` times the nearest keypoint of b that lies min_separation or more from it in
/// space. Where there is no such keypoint nothing says that the match is distinctive, and there is
/// no pair. With `mutual` the same holds from b_j to a_i. Exact, as feature_space::two_nearest.
/// Source: [Lowe2004] 7.1.
feature_space::Pairs distinctive_pairs(const Features& a, const Features& b,
                                       const RatioOptions& options);

}  // namespace plumb::match_fpfh_ratio
