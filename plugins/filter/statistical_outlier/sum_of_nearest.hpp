#pragma once
/// The sum of the smallest of many distances, without sorting them.

#include <cstddef>

namespace plumb::filter_statistical_outlier {

/// Sum of the square roots of the `wanted` smallest of squares[0 .. n-1], which are not negative;
/// `bound` is a value that at least `wanted` of them do not exceed (1 <= wanted <= n). Rearranges
/// nothing; the result depends on values, their order and `bound` only.
///
/// Counts how many do not exceed a threshold, and moves it until that many are `wanted`: counting
/// runs eight values at a time and without a branch, where selecting or sorting would stumble over
/// one at every value.
float sum_of_nearest(const float* squares, std::size_t n, std::size_t wanted, float bound);

}  // namespace plumb::filter_statistical_outlier
