#include "sum_of_nearest.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace plumb::filter_statistical_outlier {
namespace {

std::size_t count_up_to(const float* squares, std::size_t n, float threshold) {
  std::int32_t count = 0;
  for (std::size_t k = 0; k < n; ++k) count += squares[k] <= threshold;
  return static_cast<std::size_t>(count);
}

/// Eight sums side by side, so that eight roots are drawn at a time.
float sum_up_to(const float* squares, std::size_t n, float threshold) {
  float lanes[8] = {};
  std::size_t k = 0;
  for (; k + 8 <= n; k += 8)
    for (std::size_t j = 0; j < 8; ++j) {
      const float square = squares[k + j];
      lanes[j] += std::sqrt(square <= threshold ? square : 0.0f);
    }
  float sum = 0;
  for (; k < n; ++k) sum += squares[k] <= threshold ? std::sqrt(squares[k]) : 0;
  for (const float lane : lanes) sum += lane;
  return sum;
}

/// The float in the middle, by their order.
float between(float low, float high) {
  const auto a = std::bit_cast<std::uint32_t>(low), b = std::bit_cast<std::uint32_t>(high);
  return std::bit_cast<float>(a + (b - a) / 2);
}

}  // namespace

float sum_of_nearest(const float* squares, std::size_t n, std::size_t wanted, float bound) {
  float low = 0, high = bound;
  std::size_t at_low = count_up_to(squares, n, low), at_high = count_up_to(squares, n, high);
  if (at_low >= wanted) return 0;
  for (int step = 0; at_high != wanted; ++step) {
    // On a surface the count grows with the square of the distance: so a straight line hits nearly
    // at once.
    const float share = static_cast<float>(wanted - at_low) / static_cast<float>(at_high - at_low);
    float threshold = step < 6 ? low + share * (high - low) : between(low, high);
    if (!(threshold > low && threshold < high)) threshold = between(low, high);
    if (threshold == low) break;  // neighbouring floats: several squares equal `high`
    const std::size_t count = count_up_to(squares, n, threshold);
    (count < wanted ? low : high) = threshold;
    (count < wanted ? at_low : at_high) = count;
  }
  if (at_high == wanted) return sum_up_to(squares, n, high);
  return sum_up_to(squares, n, low) + static_cast<float>(wanted - at_low) * std::sqrt(high);
}

}  // namespace plumb::filter_statistical_outlier
