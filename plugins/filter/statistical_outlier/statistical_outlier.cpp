#include "statistical_outlier.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

std::vector<float> mean_distances(const Cloud& cloud, const SearchTree& tree,
                                  std::size_t neighbours, const ParallelFor& parallel) {
  constexpr std::size_t block = 4096;  // points a task
  std::vector<float> means(cloud.size());
  parallel((cloud.size() + block - 1) / block, [&](std::size_t b) {
    std::vector<SearchTree::Neighbour> found(neighbours + 1);
    const std::size_t end = std::min(cloud.size(), (b + 1) * block);
    for (std::size_t k = b * block; k < end; ++k) {
      const std::size_t n = tree.nearest(cloud.point(k), neighbours + 1, found.data());
      float sum =
          0;  // the first found, at distance 0, is the point itself or one at the same place
      for (std::size_t i = 1; i < n; ++i) sum += std::sqrt(found[i].squared_distance);
      means[k] = n > 1 ? sum / static_cast<float>(n - 1) : 0;
    }
  });
  return means;
}

std::vector<std::uint32_t> not_beyond(const std::vector<float>& values, double deviations) {
  const double n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const float v : values) sum += v;
  const double mean = sum / n;
  for (const float v : values) squares += (v - mean) * (v - mean);
  const double limit = mean + deviations * std::sqrt(squares / std::max(1.0, n - 1));
  std::vector<std::uint32_t> kept;
  kept.reserve(values.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k] <= limit) kept.push_back(static_cast<std::uint32_t>(k));
  return kept;
}

}  // namespace plumb
