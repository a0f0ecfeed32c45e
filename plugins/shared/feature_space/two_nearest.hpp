#pragma once
/// The nearest vectors in feature space, exactly, and the nearest ones that stand apart from them.

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace plumb::feature_space {

inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// What one vector finds among others.
struct TwoNearest {
  std::uint32_t first = none, second = none;  ///< places; none: there is no such vector
  double first_squared = std::numeric_limits<double>::infinity();  ///< squared distances
  double second_squared = std::numeric_limits<double>::infinity();
};

/// Whether vector k may be the second beside the first.
using Apart = std::function<bool(std::uint32_t first, std::uint32_t k)>;

/// For each vector of `of` its nearest among `among`, and the nearest of those that are not the
/// first and, where `apart` is given, stand apart from it. Both hold one vector of length
/// `dimension` after the other. Distances are compared as sums of squared differences in double; of
/// equally near vectors the one with the lower place is nearer. Vectors with a component that is
/// non-finite, or whose squared length fits no float, find nothing and are not found. Memory: a
/// copy of `among`, and 32 floats for each of its vectors.
std::vector<TwoNearest> two_nearest(std::span<const float> of, std::span<const float> among,
                                    std::size_t dimension, const Apart& apart = {});

}  // namespace plumb::feature_space
