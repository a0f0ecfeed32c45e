#include "index.hpp"

#include <limits>
#include <memory>

#include "repeatable_flann.hpp"
#include "shared/feature_space/two_nearest.hpp"

namespace plumb::match_features_flann {
namespace {

namespace fl = repeatable_flann;
using Distance = fl::L2<float>;
using Index = fl::NNIndex<Distance>;

/// The vectors that FLANN may see, and where each was.
struct Numbers {
  std::vector<float> values;
  std::vector<std::uint32_t> place;

  Numbers(std::span<const float> vectors, std::size_t dimension) {
    for (std::uint32_t k = 0; k < vectors.size() / dimension; ++k) {
      const auto vector = vectors.subspan(k * dimension, dimension);
      double length = 0;
      for (const float value : vector)
        length += static_cast<double>(value) * static_cast<double>(value);
      if (!(length < std::numeric_limits<float>::max())) continue;
      place.push_back(k);
      values.insert(values.end(), vector.begin(), vector.end());
    }
  }
  fl::Matrix<float> matrix() {
    return {values.data(), place.size(), place.empty() ? 0 : values.size() / place.size()};
  }
};

/// Centres are chosen farthest first [Gonzalez1985]: the first of each node is drawn, the rest
/// follow. Unlike those of k-means++ they are all different, so that many equal vectors end in one
/// leaf; FLANN would divide them without end.
std::unique_ptr<Index> index_over(const fl::Matrix<float>& vectors, const IndexOptions& options) {
  constexpr int kmeans_iterations = 11, most_in_leaf = 100;  // FLANN's own
  const auto branching = static_cast<int>(options.branching);
  if (options.kind == IndexKind::kmeans)
    return std::make_unique<fl::KMeansIndex<Distance>>(
        vectors, fl::KMeansIndexParams(branching, kmeans_iterations, fl::FLANN_CENTERS_GONZALES));
  if (options.kind == IndexKind::hierarchical)
    return std::make_unique<fl::HierarchicalClusteringIndex<Distance>>(
        vectors,
        fl::HierarchicalClusteringIndexParams(branching, fl::FLANN_CENTERS_GONZALES,
                                              static_cast<int>(options.trees), most_in_leaf));
  return std::make_unique<fl::KDTreeSingleIndex<Distance>>(vectors);
}

}  // namespace

std::vector<std::uint32_t> nearest(std::span<const float> of, std::span<const float> among,
                                   std::size_t dimension, const IndexOptions& options,
                                   std::uint64_t seed) {
  if (dimension == 0) return {};
  std::vector<std::uint32_t> found(of.size() / dimension, feature_space::none);
  Numbers asking(of, dimension), asked(among, dimension);
  if (asking.place.empty() || asked.place.empty()) return found;

  fl::seed_random(seed);
  const auto index = index_over(asked.matrix(), options);
  index->buildIndex();
  std::vector<std::size_t> places(asking.place.size(), std::numeric_limits<std::size_t>::max());
  std::vector<float> squared_distances(places.size());
  fl::Matrix<std::size_t> to_places(places.data(), places.size(), 1);
  fl::Matrix<float> to_distances(squared_distances.data(), places.size(), 1);
  index->knnSearch(asking.matrix(), to_places, to_distances, 1,
                   fl::SearchParams(static_cast<int>(options.checks)));
  for (std::size_t k = 0; k < places.size(); ++k)
    if (places[k] < asked.place.size()) found[asking.place[k]] = asked.place[places[k]];
  return found;
}

}  // namespace plumb::match_features_flann
