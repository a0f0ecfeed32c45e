#include "matching.hpp"

#include <algorithm>

#include "shared/feature_space/two_nearest.hpp"
#include "shared/selection/evenly.hpp"

namespace plumb::match_features_flann {
namespace {

/// The vectors with the given places.
std::vector<float> gathered(std::span<const float> vectors, std::size_t dimension,
                            const std::vector<std::uint32_t>& places) {
  std::vector<float> result;
  result.reserve(places.size() * dimension);
  for (const std::uint32_t k : places) {
    const auto vector = vectors.subspan(k * dimension, dimension);
    result.insert(result.end(), vector.begin(), vector.end());
  }
  return result;
}

double squared_distance(std::span<const float> a, std::size_t i, std::span<const float> b,
                        std::size_t j, std::size_t dimension) {
  double sum = 0;
  for (std::size_t d = 0; d < dimension; ++d) {
    const double difference =
        static_cast<double>(a[i * dimension + d]) - static_cast<double>(b[j * dimension + d]);
    sum += difference * difference;
  }
  return sum;
}

}  // namespace

Matching match(std::span<const float> a, std::span<const float> b, std::size_t dimension,
               const IndexOptions& options, std::uint32_t recall_sample, std::uint64_t seed) {
  Matching result;
  const auto there = nearest(a, b, dimension, options, seed);
  std::vector<std::uint32_t> reached;  // each once: only these can be half of a pair
  for (const std::uint32_t j : there)
    if (j != feature_space::none) reached.push_back(j);
  std::ranges::sort(reached);
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  const auto back = nearest(gathered(b, dimension, reached), a, dimension, options, seed);
  for (std::size_t k = 0; k < reached.size(); ++k)
    if (back[k] != feature_space::none && there[back[k]] == reached[k])
      result.pairs.emplace_back(back[k], reached[k]);
  std::ranges::sort(result.pairs);

  constexpr double rounding = 1e-5;  // of a float's sum of some hundred squares
  const auto sample = selection::evenly(there.size(), recall_sample);
  const auto judged = feature_space::two_nearest(gathered(a, dimension, sample), b, dimension);
  for (std::size_t n = 0; n < sample.size(); ++n) {
    if (judged[n].first == feature_space::none) continue;
    ++result.sampled;
    const std::uint32_t j = there[sample[n]];
    result.exact += j != feature_space::none && squared_distance(a, sample[n], b, j, dimension) <=
                                                    judged[n].first_squared * (1 + rounding);
  }
  return result;
}

}  // namespace plumb::match_features_flann
