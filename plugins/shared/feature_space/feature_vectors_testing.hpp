#pragma once
/// For tests of what searches in feature space.

#include <cmath>
#include <cstdint>
#include <vector>

#include "plumb/data/random.hpp"

namespace plumb::feature_space {

/// Vectors like histograms: most of the mass in few bins, round twenty centres that are the same
/// for all seeds.
inline std::vector<float> histograms(std::size_t count, std::size_t dimension, std::uint64_t seed,
                                     double spread = 5) {
  Random random(seed), centre(99);
  std::vector<float> centres(20 * dimension), result;
  for (auto& value : centres) value = static_cast<float>(std::pow(centre.uniform(), 6) * 100);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t c = random.below(20);
    for (std::size_t d = 0; d < dimension; ++d)
      result.push_back(centres[c * dimension + d] +
                       static_cast<float>(spread * (random.uniform() - 0.5)));
  }
  return result;
}

}  // namespace plumb::feature_space
