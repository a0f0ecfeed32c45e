#pragma once
/// The rigid motion that a largest set of compatible pairs agrees on.

#include "plumb/slam/graph.hpp"

namespace plumb::prune_consistency {

enum class Select { clique, core };

struct ConsistencyOptions {
  double max_correspondence_distance = 0.5;  ///< [m] an inlier has |p - T_i_j q| up to this
  Select select = Select::clique;
  std::uint32_t max_pairs = 1500;     ///< evenly chosen of more, for the graph
  std::uint32_t max_branches = 1000;  ///< of the search for a clique

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("max_correspondence_distance", &ConsistencyOptions::max_correspondence_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("distance between the two points of an inlier under the motion");
    is.choice("select", &ConsistencyOptions::select,
              {{"clique", Select::clique, "a largest set of pairs that are all compatible"},
               {"core", Select::core,
                "the pairs that are each compatible with most others among themselves: quicker, "
                "and less strict"}})
        .doc("which pairs the motion is fitted to")
        .source("[Yang2021] for clique, [Shi2021] for core");
    is.param("max_pairs", &ConsistencyOptions::max_pairs)
        .range(3, 10000)
        .doc("pairs that are compared with each other, evenly chosen of more");
    is.param("max_branches", &ConsistencyOptions::max_branches)
        .range(0, 1e9)
        .doc("branches of the search for a clique, after which the largest one found is taken");
  }
};

struct Consistent {
  Pose T_i_j;                          ///< of the inliers
  std::vector<std::uint32_t> inliers;  ///< in order; fewer than three: there is no motion
  std::uint32_t selected = 0;          ///< pairs in the clique or core
  bool largest = true;                 ///< whether the clique is proved to be a largest one
};

/// Pairs are joined where the lengths between them differ by at most twice
/// `max_correspondence_distance`, as the lengths of two inliers do. Of the largest clique of that
/// graph, or of its innermost core, graduated non-convexity finds the motion that most of it agrees
/// on; it is fitted again to the inliers among all pairs as long as their number grows. Nothing is
/// drawn. Memory goes with max_pairs^2, at most 5 bytes each. Source: [Yang2021], [Shi2021],
/// [Yang2020].
Consistent consistent_pairs(const Matches& matches, const ConsistencyOptions& options);

/// T_i_j with the least sum of min(|p_k - T_i_j q_k|^2, max_distance^2) over `pairs` (three or
/// more), by graduated non-convexity: weighted fits, the loss at first convex. Returns the weight
/// of each pair, 0 to 1, all 0 where no motion was found. Source: [Yang2020], truncated least
/// squares.
std::vector<double> graduated_fit(const Matches& matches, const std::vector<std::uint32_t>& pairs,
                                  double max_distance, Pose& T_i_j);

}  // namespace plumb::prune_consistency
