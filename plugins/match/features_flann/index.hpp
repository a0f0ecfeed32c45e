#pragma once
/// The nearest vectors by one of FLANN's indices.

#include <cstdint>
#include <span>
#include <vector>

namespace plumb::match_features_flann {

enum class IndexKind { exact_tree, kmeans, hierarchical };

struct IndexOptions {
  IndexKind kind = IndexKind::exact_tree;
  std::uint32_t branching = 32;  ///< children of a node; of kmeans and hierarchical
  std::uint32_t trees = 4;       ///< of hierarchical
  std::uint32_t checks = 128;    ///< vectors that are looked at for each one asked; of both

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.choice("index", &IndexOptions::kind,
              {{"exact_tree", IndexKind::exact_tree, "one kd-tree, which finds the nearest"},
               {"kmeans", IndexKind::kmeans, "a tree of k-means clusters"},
               {"hierarchical", IndexKind::hierarchical,
                "several trees of clusters round vectors of the set"}})
        .doc("how FLANN searches; all but the first may miss the nearest");
    is.param("branching", &IndexOptions::branching)
        .range(2, 1000)
        .doc("clusters that a node is divided into; for 'kmeans' and 'hierarchical'");
    is.param("trees", &IndexOptions::trees).range(1, 64).doc("for 'hierarchical'");
    is.param("checks", &IndexOptions::checks)
        .range(1, 1e6)
        .doc("vectors that are looked at for each keypoint; for 'kmeans' and 'hierarchical'");
  }
};

/// For each vector of `of` the place of the nearest that the index finds among `among`;
/// feature_space::none where it finds none. Both hold one vector of length `dimension` after the
/// other. Distances are sums of squared differences in float. Vectors with a component that is
/// non-finite, or whose squared length fits no float, find nothing and are not found. The same
/// `seed` gives the same places, whatever other threads do. Source: [Muja2014]; centres by
/// [Gonzalez1985].
std::vector<std::uint32_t> nearest(std::span<const float> of, std::span<const float> among,
                                   std::size_t dimension, const IndexOptions& options,
                                   std::uint64_t seed);

}  // namespace plumb::match_features_flann
