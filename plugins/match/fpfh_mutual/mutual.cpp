#include "mutual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace plumb {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double infinity = std::numeric_limits<double>::infinity();

double squared_distance(const float* a, const float* b, std::size_t dimension) {
  double sum = 0;
  for (std::size_t d = 0; d < dimension; ++d) {
    const double difference = static_cast<double>(a[d]) - static_cast<double>(b[d]);
    sum += difference * difference;
  }
  return sum;
}

/// The nearest so far of each vector of one side.
struct Nearest {
  explicit Nearest(std::size_t count) : distance(count, infinity), index(count, none) {}
  void offer(std::size_t of, std::size_t other, double d) {
    if (d < distance[of] || (d == distance[of] && other < index[of])) {
      distance[of] = d;
      index[of] = static_cast<std::uint32_t>(other);
    }
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

constexpr std::size_t
    rows = 6,
    columns = 16;  // of one tile: 12 sums, 2 loads and 1 broadcast fill 15 of 16 registers
constexpr std::size_t chunk = 40;  // row panels that stay in the nearest cache

/// Vectors in panels of `width`: of each panel first all first components, then all second ones.
/// Unused places are at infinity.
struct Panels {
  std::vector<float> values;
  std::vector<float> norms;   ///< a little less than the squared length
  std::vector<float> limits;  ///< not less than the distance of the nearest so far
  std::size_t count;

  Panels(std::span<const float> vectors, std::size_t dimension, std::size_t width) {
    const std::size_t n = vectors.size() / dimension;
    count = (n + width - 1) / width;
    values.assign(count * width * dimension, 0);
    norms.assign(count * width, std::numeric_limits<float>::infinity());
    limits.assign(count * width, -std::numeric_limits<float>::infinity());
    // The sum of products in float is off by at most (dimension + 5) / 2^24 of the two squared
    // lengths' sum. With norms that much smaller, norm_i + norm_j - 2 a_i b_j is never greater than
    // the true squared distance.
    const double slack = static_cast<double>(dimension + 8) * 0x1.0p-23;
    for (std::size_t k = 0; k < n; ++k) {
      const float* vector = &vectors[k * dimension];
      double squared = 0;
      for (std::size_t d = 0; d < dimension; ++d)
        squared += static_cast<double>(vector[d]) * vector[d];
      if (!std::isfinite(squared)) continue;
      for (std::size_t d = 0; d < dimension; ++d)
        values[(k / width * dimension + d) * width + k % width] = vector[d];
      norms[k] = static_cast<float>(squared * (1 - slack));
      limits[k] = std::numeric_limits<float>::max();
    }
  }
};

/// Twice the scalar products of 6 row vectors with 16 column vectors.
inline void multiply(const float* a, const float* b, std::size_t dimension,
                     __m256 (&sum)[rows][2]) {
  for (auto& row : sum) row[0] = row[1] = _mm256_setzero_ps();
  for (std::size_t d = 0; d < dimension; ++d, a += rows, b += columns) {
    const __m256 b0 = _mm256_loadu_ps(b), b1 = _mm256_loadu_ps(b + 8);
#pragma GCC unroll 6
    for (std::size_t r = 0; r < rows; ++r) {
      const __m256 value = _mm256_broadcast_ss(a + r);
      sum[r][0] = _mm256_fmadd_ps(value, b0, sum[r][0]);
      sum[r][1] = _mm256_fmadd_ps(value, b1, sum[r][1]);
    }
  }
}

/// Goes through all pairs by tiles of products in float and looks closely only at pairs that may be
/// nearer than what is known.
class Search {
 public:
  Search(std::span<const float> a, std::span<const float> b, std::size_t dimension)
      : a_(a),
        b_(b),
        dimension_(dimension),
        row_(a, dimension, rows),
        column_(b, dimension, columns),
        of_a_(a.size() / dimension),
        of_b_(b.size() / dimension) {}

  std::vector<std::pair<std::uint32_t, std::uint32_t>> run() {
    for (std::size_t first = 0; first < row_.count; first += chunk)
      for (std::size_t c = 0; c < column_.count; ++c)
        for (std::size_t r = first; r < std::min(first + chunk, row_.count); ++r) tile(r, c);
    return agreed(of_a_, of_b_);
  }

 private:
  void tile(std::size_t r, std::size_t c) {
    __m256 sum[rows][2];
    multiply(&row_.values[r * rows * dimension_], &column_.values[c * columns * dimension_],
             dimension_, sum);
    const float* norm = &column_.norms[c * columns];
    const float* limit = &column_.limits[c * columns];
    const __m256 minus_two = _mm256_set1_ps(-2);
    unsigned masks[rows], any = 0;
#pragma GCC unroll 6
    for (std::size_t k = 0; k < rows; ++k) {
      const __m256 row_norm = _mm256_broadcast_ss(&row_.norms[r * rows + k]);
      const __m256 row_limit = _mm256_broadcast_ss(&row_.limits[r * rows + k]);
      masks[k] = 0;
#pragma GCC unroll 2
      for (unsigned half = 0; half < 2; ++half) {
        const __m256 norms = _mm256_add_ps(row_norm, _mm256_loadu_ps(norm + 8 * half));
        const __m256 distance = _mm256_fmadd_ps(sum[k][half], minus_two, norms);
        const __m256 known = _mm256_max_ps(row_limit, _mm256_loadu_ps(limit + 8 * half));
        masks[k] |=
            static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(distance, known, _CMP_LE_OQ)))
            << (8 * half);
      }
      any |= masks[k];
    }
    if (any == 0) return;
    for (std::size_t k = 0; k < rows; ++k)
      for (unsigned mask = masks[k]; mask; mask &= mask - 1)
        look(r * rows + k, c * columns + static_cast<std::size_t>(__builtin_ctz(mask)));
  }

  void look(std::size_t i, std::size_t j) {
    const double d = squared_distance(&a_[i * dimension_], &b_[j * dimension_], dimension_);
    if (!std::isfinite(d)) return;
    of_a_.offer(i, j, d);
    of_b_.offer(j, i, d);
    row_.limits[i] = not_less(of_a_.distance[i]);
    column_.limits[j] = not_less(of_b_.distance[j]);
  }

  static float not_less(double value) {
    const auto near = static_cast<float>(value);
    return near >= value ? near : std::nextafter(near, std::numeric_limits<float>::infinity());
  }

  std::span<const float> a_, b_;
  std::size_t dimension_;
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

}  // namespace plumb
