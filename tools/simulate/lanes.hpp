#pragma once
/// Eight floats that the processor handles at once.

#include <array>

namespace plumb::simulate {

constexpr int lane_count = 8;

/// The compiler's own vector type: AVX registers where there are such, else pairs of smaller ones.
/// Only ever passed by reference, which is the same with and without AVX.
typedef float Lanes __attribute__((vector_size(32)));

inline void smaller(Lanes& a, const Lanes& b) { a = b < a ? b : a; }
inline void greater(Lanes& a, const Lanes& b) { a = b > a ? b : a; }

/// The least of the eight.
inline float least(const Lanes& v) {
  Lanes a = v;
  smaller(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3));
  smaller(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
  smaller(a, __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6));
  return a[0];
}

}  // namespace plumb::simulate
