#include "pair_counts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace plumb::describe_fpfh {

PairCounts count_pairs_plainly(const Oriented& point, const Candidates& candidates,
                               float squared_radius) {
  PairCounts counts{};
  const auto bin = [](float from_0_to_1) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(11.0f * from_0_to_1), 0, 10));
  };
  for (std::size_t k = 0; k < candidates.size; ++k) {
    Eigen::Vector3f d(candidates.x[k] - point.x, candidates.y[k] - point.y,
                      candidates.z[k] - point.z);
    const float squared = (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
    if (!(squared <= squared_radius)) continue;
    ++counts.neighbours;
    if (squared == 0) continue;
    Eigen::Vector3f n1(point.nx, point.ny, point.nz);
    Eigen::Vector3f n2(candidates.nx[k], candidates.ny[k], candidates.nz[k]);
    if (std::abs(n1.dot(d)) < std::abs(n2.dot(d))) {
      std::swap(n1, n2);
      d = -d;
    }
    const Eigen::Vector3f across = d.cross(n1);
    const float length = across.norm();
    if (length == 0) continue;
    const Eigen::Vector3f v = across / length, w = n1.cross(v);
    const float theta = std::atan2(w.dot(n2), n1.dot(n2));
    const float turn = theta / (2 * std::numbers::pi_v<float>)+0.5f;
    ++counts.bins[bin(turn)];
    ++counts.bins[fpfh_bins + bin(0.5f * (v.dot(n2) + 1))];
    ++counts.bins[2 * fpfh_bins + bin(0.5f * (n1.dot(d) / std::sqrt(squared) + 1))];
  }
  return counts;
}

#if defined(__AVX2__) && defined(__FMA__)
namespace {

struct Vec {
  __m256 x, y, z;
};
inline __m256 dot(const Vec& a, const Vec& b) {
  return _mm256_fmadd_ps(a.z, b.z, _mm256_fmadd_ps(a.y, b.y, _mm256_mul_ps(a.x, b.x)));
}
inline Vec cross(const Vec& a, const Vec& b) {
  return {_mm256_fmsub_ps(a.y, b.z, _mm256_mul_ps(a.z, b.y)),
          _mm256_fmsub_ps(a.z, b.x, _mm256_mul_ps(a.x, b.z)),
          _mm256_fmsub_ps(a.x, b.y, _mm256_mul_ps(a.y, b.x))};
}
/// b where `mask` is set, else a.
inline Vec choose(const Vec& a, const Vec& b, __m256 mask) {
  return {_mm256_blendv_ps(a.x, b.x, mask), _mm256_blendv_ps(a.y, b.y, mask),
          _mm256_blendv_ps(a.z, b.z, mask)};
}
/// floor(11 * (f + 1) / 2), kept within 0 to 10.
inline __m256i linear_bin(__m256 f) {
  const __m256 half = _mm256_set1_ps(5.5f);
  const __m256i bin = _mm256_cvttps_epi32(_mm256_fmadd_ps(f, half, half));
  return _mm256_min_epi32(bin, _mm256_set1_epi32(10));
}
/// The bin of atan2(y, x), without computing it: the angle of (x, |y|) lies beyond the edge e if
/// |y| cos e > x sin e, and the bins of y < 0 mirror those of y > 0.
inline __m256i angular_bin(__m256 y, __m256 x) {
  // Cosine and sine of pi k / 11, k = 1, 3, 5, 7, 9.
  static constexpr float cosine[5] = {0.959492974f, 0.654860734f, 0.142314838f, -0.415415013f,
                                      -0.841253533f};
  static constexpr float sine[5] = {0.281732557f, 0.755749574f, 0.989821442f, 0.909631995f,
                                    0.540640817f};
  const __m256 sign = _mm256_set1_ps(-0.0f);
  const __m256 positive = _mm256_andnot_ps(sign, y);
  __m256i beyond = _mm256_setzero_si256();  // minus the number of edges passed
  for (int e = 0; e < 5; ++e) {
    const __m256 far = _mm256_mul_ps(positive, _mm256_set1_ps(cosine[e]));
    const __m256 edge = _mm256_mul_ps(x, _mm256_set1_ps(sine[e]));
    beyond = _mm256_add_epi32(beyond, _mm256_castps_si256(_mm256_cmp_ps(far, edge, _CMP_GT_OQ)));
  }
  const __m256i negative = _mm256_srai_epi32(_mm256_castps_si256(y), 31);
  // 5 + passed for y >= 0, 5 - passed for y < 0
  const __m256i passed = _mm256_sub_epi32(
      _mm256_xor_si256(_mm256_sub_epi32(_mm256_setzero_si256(), beyond), negative), negative);
  return _mm256_add_epi32(passed, _mm256_set1_epi32(5));
}

constexpr std::size_t most_codes = 255;  // then a byte that counts is full

/// Counts codes: in each 16 bytes four of theta, four of alpha, four of phi, four to ignore; 15 is
/// no bin.
void add_codes(const __m256i* codes, std::size_t count, PairCounts& to) {
  __m256i sums[fpfh_bins];
  for (auto& sum : sums) sum = _mm256_setzero_si256();
  for (std::size_t k = 0; k < count; ++k) {
    const __m256i code = _mm256_load_si256(codes + k);
#pragma GCC unroll 11
    for (std::size_t b = 0; b < fpfh_bins; ++b)
      sums[b] =
          _mm256_sub_epi8(sums[b], _mm256_cmpeq_epi8(code, _mm256_set1_epi8(static_cast<char>(b))));
  }
  const __m256i low = _mm256_set1_epi64x(0xffffffff);
  for (std::size_t b = 0; b < fpfh_bins; ++b) {
    // Bytes 0-3 of each 8 are theta (phi in the upper 8), bytes 4-7 alpha (nothing).
    const __m256i zero = _mm256_setzero_si256();
    const __m256i even = _mm256_sad_epu8(_mm256_and_si256(sums[b], low), zero);
    const __m256i odd = _mm256_sad_epu8(_mm256_andnot_si256(low, sums[b]), zero);
    const auto sum = [](__m256i v, auto lane) {
      constexpr int l = decltype(lane)::value;
      return static_cast<std::uint32_t>(_mm256_extract_epi64(v, l) +
                                        _mm256_extract_epi64(v, l + 2));
    };
    to.bins[b] += sum(even, std::integral_constant<int, 0>());
    to.bins[fpfh_bins + b] += sum(odd, std::integral_constant<int, 0>());
    to.bins[2 * fpfh_bins + b] += sum(even, std::integral_constant<int, 1>());
  }
}

}  // namespace

PairCounts count_pairs(const Oriented& point, const Candidates& candidates, float squared_radius) {
  PairCounts counts{};
  alignas(32) __m256i codes[most_codes];
  std::size_t coded = 0;
  const Vec here{_mm256_set1_ps(point.x), _mm256_set1_ps(point.y), _mm256_set1_ps(point.z)};
  const Vec normal{_mm256_set1_ps(point.nx), _mm256_set1_ps(point.ny), _mm256_set1_ps(point.nz)};
  const __m256 most = _mm256_set1_ps(squared_radius), zero = _mm256_setzero_ps();
  const __m256 unsigned_bits = _mm256_castsi256_ps(_mm256_set1_epi32(0x7fffffff));
  for (std::size_t k = 0; k < candidates.size; k += Candidates::lanes) {
    const Vec d{_mm256_sub_ps(_mm256_loadu_ps(&candidates.x[k]), here.x),
                _mm256_sub_ps(_mm256_loadu_ps(&candidates.y[k]), here.y),
                _mm256_sub_ps(_mm256_loadu_ps(&candidates.z[k]), here.z)};
    const __m256 squared = _mm256_add_ps(
        _mm256_add_ps(_mm256_mul_ps(d.x, d.x), _mm256_mul_ps(d.y, d.y)), _mm256_mul_ps(d.z, d.z));
    const __m256 near = _mm256_cmp_ps(squared, most, _CMP_LE_OQ);
    const auto mask = static_cast<unsigned>(_mm256_movemask_ps(near));
    if (mask == 0) continue;
    counts.neighbours += static_cast<std::uint32_t>(std::popcount(mask));

    const Vec other{_mm256_loadu_ps(&candidates.nx[k]), _mm256_loadu_ps(&candidates.ny[k]),
                    _mm256_loadu_ps(&candidates.nz[k])};
    const __m256 along = dot(normal, d), along_other = dot(other, d);
    const __m256 swap = _mm256_cmp_ps(_mm256_and_ps(along, unsigned_bits),
                                      _mm256_and_ps(along_other, unsigned_bits), _CMP_LT_OQ);
    const Vec n1 = choose(normal, other, swap), n2 = choose(other, normal, swap);
    // d changes its sign with the swap: of what follows only phi and w n2 see it.
    const __m256 u_d = _mm256_blendv_ps(along, _mm256_sub_ps(zero, along_other), swap);
    const __m256 d_n2 = _mm256_blendv_ps(along_other, _mm256_sub_ps(zero, along), swap);
    const Vec across = cross(d, n1);
    const __m256 across_sign = _mm256_and_ps(swap, _mm256_set1_ps(-0.0f));
    const __m256 squared_across = dot(across, across);
    const __m256 across_n2 = _mm256_xor_ps(dot(across, n2), across_sign);
    const __m256 u_n2 = dot(n1, n2);

    const __m256 length = _mm256_sqrt_ps(squared), wide = _mm256_sqrt_ps(squared_across);
    const __m256 inverse = _mm256_div_ps(_mm256_set1_ps(1), _mm256_mul_ps(length, wide));
    // w n2 = (d - u (u d)) n2 / |d x u|, both arguments of atan2 times |d x u|
    const __m256i theta = angular_bin(_mm256_fnmadd_ps(u_d, u_n2, d_n2), _mm256_mul_ps(wide, u_n2));
    const __m256i alpha = linear_bin(_mm256_mul_ps(across_n2, _mm256_mul_ps(length, inverse)));
    const __m256i phi = linear_bin(_mm256_mul_ps(u_d, _mm256_mul_ps(wide, inverse)));

    const __m256 framed = _mm256_and_ps(near, _mm256_cmp_ps(squared_across, zero, _CMP_GT_OQ));
    const __m256i no_bin = _mm256_set1_epi32(15);
    const auto valid = [&](__m256i bin) {
      return _mm256_blendv_epi8(no_bin, bin, _mm256_castps_si256(framed));
    };
    codes[coded++] = _mm256_packus_epi16(_mm256_packs_epi32(valid(theta), valid(alpha)),
                                         _mm256_packs_epi32(valid(phi), no_bin));
    if (coded == most_codes) {
      add_codes(codes, coded, counts);
      coded = 0;
    }
  }
  add_codes(codes, coded, counts);
  return counts;
}
#else
PairCounts count_pairs(const Oriented& point, const Candidates& candidates, float squared_radius) {
  return count_pairs_plainly(point, candidates, squared_radius);
}
#endif

}  // namespace plumb::describe_fpfh
