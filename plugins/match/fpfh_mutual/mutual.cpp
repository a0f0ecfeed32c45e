#include "mutual.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "panels.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace plumb::match_fpfh_mutual {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// In four sums side by side, one for each component modulo 4.
double squared_distance(const float* a, const float* b, std::size_t dimension) {
  double sums[4] = {};
  std::size_t d = 0;
  for (; d + 4 <= dimension; d += 4)
    for (std::size_t k = 0; k < 4; ++k) {
      const double difference = static_cast<double>(a[d + k]) - static_cast<double>(b[d + k]);
      sums[k] += difference * difference;
    }
  for (; d < dimension; ++d) {
    const double difference = static_cast<double>(a[d]) - static_cast<double>(b[d]);
    sums[d % 4] += difference * difference;
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// The nearest so far of each vector of one side.
struct Nearest {
  explicit Nearest(std::size_t count) : distance(count, infinity), index(count, none) {}
  /// Returns whether it is the nearest now.
  bool offer(std::size_t of, std::size_t other, double d) {
    if (!(d < distance[of] || (d == distance[of] && other < index[of]))) return false;
    distance[of] = d;
    index[of] = static_cast<std::uint32_t>(other);
    return true;
  }
  std::vector<double> distance;
  std::vector<std::uint32_t> index;
};

std::vector<std::pair<std::uint32_t, std::uint32_t>> agreed(const Nearest& of_a,
                                                            const Nearest& of_b) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < of_a.index.size(); ++i)
    if (const auto j = of_a.index[i]; j != none && of_b.index[j] == i) pairs.emplace_back(i, j);
  return pairs;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> mutual_nearest_plainly(
    std::span<const float> a, std::span<const float> b, std::size_t dimension) {
  const std::size_t n = a.size() / dimension, m = b.size() / dimension;
  Nearest of_a(n), of_b(m);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      const double d = squared_distance(&a[i * dimension], &b[j * dimension], dimension);
      if (!std::isfinite(d)) continue;
      of_a.offer(i, j, d);
      of_b.offer(j, i, d);
    }
  return agreed(of_a, of_b);
}

#if defined(__AVX2__) && defined(__FMA__)
namespace {

// Of one tile: 12 sums, 2 loads and 1 broadcast fill 15 of 16 registers.
constexpr std::size_t rows = 6, columns = 16;

using Sums = __m256[rows][2];

/// Adds the products of coordinates first .. end-1 of 6 row vectors and 16 column vectors.
inline void multiply(const float* a, const float* b, std::size_t first, std::size_t end,
                     Sums& sum) {
  for (std::size_t d = first; d < end; ++d) {
    const __m256 b0 = _mm256_loadu_ps(b + d * columns), b1 = _mm256_loadu_ps(b + d * columns + 8);
#pragma GCC unroll 6
    for (std::size_t r = 0; r < rows; ++r) {
      const __m256 value = _mm256_broadcast_ss(a + d * rows + r);
      sum[r][0] = _mm256_fmadd_ps(value, b0, sum[r][0]);
      sum[r][1] = _mm256_fmadd_ps(value, b1, sum[r][1]);
    }
  }
}

/// Bit c of masks[r] tells that row r and column c may be nearer than the nearest so far of either.
/// Returns whether any may.
inline unsigned compare(const Sums& sum, const float* row_norms, const float* column_norms,
                        const float* row_limits, const float* column_limits,
                        unsigned (&masks)[rows]) {
  const __m256 minus_two = _mm256_set1_ps(-2);
  unsigned any = 0;
#pragma GCC unroll 6
  for (std::size_t r = 0; r < rows; ++r) {
    const __m256 norm = _mm256_broadcast_ss(row_norms + r),
                 limit = _mm256_broadcast_ss(row_limits + r);
    masks[r] = 0;
#pragma GCC unroll 2
    for (unsigned half = 0; half < 2; ++half) {
      const __m256 norms = _mm256_add_ps(norm, _mm256_loadu_ps(column_norms + 8 * half));
      const __m256 distance = _mm256_fmadd_ps(sum[r][half], minus_two, norms);
      const __m256 known = _mm256_max_ps(limit, _mm256_loadu_ps(column_limits + 8 * half));
      const auto near = _mm256_movemask_ps(_mm256_cmp_ps(distance, known, _CMP_LE_OQ));
      masks[r] |= static_cast<unsigned>(near) << (8 * half);
    }
    any |= masks[r];
  }
  return any;
}

/// Squared distances between the box of one panel and those of eight others from `first` on; never
/// more than they are.
inline __m256 box_distances(const Panels& of, std::size_t panel, const Panels& others,
                            std::size_t first) {
  __m256 sum = _mm256_setzero_ps();
  for (std::size_t axis = 0; axis < Panels::box_axes; ++axis) {
    const __m256 low = _mm256_broadcast_ss(&of.low[axis * of.stride() + panel]);
    const __m256 high = _mm256_broadcast_ss(&of.high[axis * of.stride() + panel]);
    const __m256 above =
        _mm256_sub_ps(_mm256_loadu_ps(&others.low[axis * others.stride() + first]), high);
    const __m256 below =
        _mm256_sub_ps(low, _mm256_loadu_ps(&others.high[axis * others.stride() + first]));
    const __m256 gap = _mm256_max_ps(_mm256_max_ps(above, below), _mm256_setzero_ps());
    sum = _mm256_fmadd_ps(gap, gap, sum);
  }
  return _mm256_mul_ps(sum, _mm256_set1_ps(1 - 0x1.0p-18f));
}

/// Which panel's box is nearest.
std::size_t nearest_box(const Panels& of, std::size_t panel, const Panels& others) {
  float best = std::numeric_limits<float>::infinity();
  std::size_t at = 0;
  for (std::size_t first = 0; first < others.count(); first += 8) {
    const __m256 distance = box_distances(of, panel, others, first);
    const __m256 nearer = _mm256_cmp_ps(distance, _mm256_set1_ps(best), _CMP_LT_OQ);
    if (_mm256_movemask_ps(nearer) == 0) continue;
    alignas(32) float distances[8];
    _mm256_store_ps(distances, distance);
    for (std::size_t k = 0; k < 8; ++k)
      if (distances[k] < best) {
        best = distances[k];
        at = first + k;
      }
  }
  return at;
}

/// Leaves out panels whose boxes lie too far apart, then pairs whose first coordinates do, then
/// those whose product in float says so, and looks closely at what is left.
class Search {
 public:
  Search(std::span<const float> a, std::span<const float> b, std::size_t dimension)
      : a_(a),
        b_(b),
        dimension_(dimension),
        principal_(a, b, dimension),
        row_(a, principal_, rows),
        column_(b, principal_, columns),
        of_a_(a.size() / dimension),
        of_b_(b.size() / dimension) {}

  std::vector<std::pair<std::uint32_t, std::uint32_t>> run() {
    if (row_.count() == 0 || column_.count() == 0) return {};
    // First each panel with the nearest one of the other side, so that good limits are known early.
    for (std::size_t r = 0; r < row_.count(); ++r) tile(r, nearest_box(row_, r, column_));
    for (std::size_t c = 0; c < column_.count(); ++c) tile(nearest_box(column_, c, row_), c);
    for (std::size_t r = 0; r < row_.count(); ++r)
      for (std::size_t first = 0; first < column_.count(); first += 8) {
        const __m256 known = _mm256_max_ps(_mm256_loadu_ps(&column_.reach[first]),
                                           _mm256_broadcast_ss(&row_.reach[r]));
        const __m256 near =
            _mm256_cmp_ps(box_distances(row_, r, column_, first), known, _CMP_LE_OQ);
        for (auto mask = static_cast<unsigned>(_mm256_movemask_ps(near)); mask; mask &= mask - 1)
          tile(r, first + static_cast<std::size_t>(std::countr_zero(mask)));
      }
    return agreed(of_a_, of_b_);
  }

 private:
  void tile(std::size_t r, std::size_t c) {
    const std::size_t head = std::min(Panels::head_axes, dimension_);
    const float *row_limits = &row_.limits[r * rows], *column_limits = &column_.limits[c * columns];
    Sums sum;
    for (auto& row : sum) row[0] = row[1] = _mm256_setzero_ps();
    unsigned masks[rows];
    multiply(row_.values(r), column_.values(c), 0, head, sum);
    if (!compare(sum, &row_.head_norms[r * rows], &column_.head_norms[c * columns], row_limits,
                 column_limits, masks))
      return;
    multiply(row_.values(r), column_.values(c), head, dimension_, sum);
    if (!compare(sum, &row_.norms[r * rows], &column_.norms[c * columns], row_limits, column_limits,
                 masks))
      return;
    for (std::size_t k = 0; k < rows; ++k)
      for (unsigned mask = masks[k]; mask; mask &= mask - 1)
        look(r * rows + k, c * columns + static_cast<std::size_t>(std::countr_zero(mask)));
  }

  void look(std::size_t row, std::size_t column) {
    const auto i = row_.index[row], j = column_.index[column];
    const double d = squared_distance(&a_[i * dimension_], &b_[j * dimension_], dimension_);
    if (of_a_.offer(i, j, d)) row_.shorten(row, d);
    if (of_b_.offer(j, i, d)) column_.shorten(column, d);
  }

  std::span<const float> a_, b_;
  std::size_t dimension_;
  PrincipalAxes principal_;
  Panels row_, column_;
  Nearest of_a_, of_b_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> mutual_nearest(std::span<const float> a,
                                                                    std::span<const float> b,
                                                                    std::size_t dimension) {
  if (a.empty() || b.empty()) return {};
  return Search(a, b, dimension).run();
}
#else
std::vector<std::pair<std::uint32_t, std::uint32_t>> mutual_nearest(std::span<const float> a,
                                                                    std::span<const float> b,
                                                                    std::size_t dimension) {
  return mutual_nearest_plainly(a, b, dimension);
}
#endif

}  // namespace plumb::match_fpfh_mutual
