/// How the ground takes its shape from the path; what it is to a ray is in ground.cpp.

#include <algorithm>
#include <cmath>

#include "simulate/ground.hpp"
#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using Grid = std::vector<float>;

struct Size {
  int columns, rows;
  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(i);
  }
};

/// Running mean over 2 r + 1 samples of the line that starts at `first` with the given stride;
/// outside counts as 0.
void blur_line(Grid& grid, std::size_t first, std::size_t stride, int n, int r, Grid& line) {
  line.resize(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k)
    line[static_cast<std::size_t>(k)] = grid[first + static_cast<std::size_t>(k) * stride];
  double sum = 0;
  for (int k = 0; k < std::min(r, n); ++k)
    sum += static_cast<double>(line[static_cast<std::size_t>(k)]);
  for (int k = 0; k < n; ++k) {
    if (k + r < n) sum += static_cast<double>(line[static_cast<std::size_t>(k + r)]);
    if (k - r > 0) sum -= static_cast<double>(line[static_cast<std::size_t>(k - r - 1)]);
    grid[first + static_cast<std::size_t>(k) * stride] =
        static_cast<float>(std::max(0.0, sum / (2 * r + 1)));
  }
}

/// Three running means each way: nearly a Gaussian, of deviation about r + 0.5 samples. For grids
/// without negative values.
Grid blurred(Grid grid, const Size& size, int r) {
  Grid line;
  for (int pass = 0; pass < 3; ++pass) {
    for (int j = 0; j < size.rows; ++j) blur_line(grid, size.at(0, j), 1, size.columns, r, line);
    for (int i = 0; i < size.columns; ++i)
      blur_line(grid, size.at(i, 0), static_cast<std::size_t>(size.columns), size.rows, r, line);
  }
  return grid;
}

/// Smooth noise in -1 to 1 with features of about `wave` [m].
float bumps(float x, float y, float wave, std::uint64_t seed) {
  const float gx = x / wave, gy = y / wave;
  const float i = std::floor(gx), j = std::floor(gy);
  const auto corner = [&](float a, float b) {
    return 2 * unit(mix(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(i + a)),
                        static_cast<std::uint64_t>(static_cast<std::int64_t>(j + b)))) -
           1;
  };
  const auto ease = [](float s) { return s * s * (3 - 2 * s); };
  const float u = ease(gx - i), v = ease(gy - j);
  return (1 - v) * ((1 - u) * corner(0, 0) + u * corner(1, 0)) +
         v * ((1 - u) * corner(0, 1) + u * corner(1, 1));
}

float ramp(float v, float low, float high) {
  return std::clamp((v - low) / (high - low), 0.0f, 1.0f);
}

}  // namespace

Ground ground_under(const std::vector<Eigen::Vector3f>& path, float kerb, float margin,
                    std::uint64_t seed, float unevenness) {
  Box box;
  for (const auto& p : path) box.add(p);
  const Eigen::Vector2f low = box.low.head<2>().array() - margin;
  const Eigen::Vector2f extent = box.high.head<2>().array() + margin - low.array();
  constexpr float most_samples = 2e7f;  // a finer grid costs more than it shows
  const float cell = std::max(1.0f, std::sqrt(extent.prod() / most_samples));
  const Size size{static_cast<int>(extent.x() / cell) + 2, static_cast<int>(extent.y() / cell) + 2};
  const std::size_t n = size.at(0, size.rows);

  Grid weight(n, 0.0f), sum(n, 0.0f), distance(n, 1e3f);
  const int reach = static_cast<int>(std::ceil((kerb + 4) / cell));
  for (const auto& p : path) {
    const Eigen::Vector2f g = (p.head<2>() - low) / cell;
    const int i = static_cast<int>(g.x() + 0.5f), j = static_cast<int>(g.y() + 0.5f);
    weight[size.at(i, j)] += 1;
    sum[size.at(i, j)] += p.z() - box.low.z();  // never negative, as the blur wants it
    for (int b = std::max(0, j - reach); b <= std::min(size.rows - 1, j + reach); ++b)
      for (int a = std::max(0, i - reach); a <= std::min(size.columns - 1, i + reach); ++a) {
        float& d = distance[size.at(a, b)];
        d = std::min(
            d, cell * std::hypot(static_cast<float>(a) - g.x(), static_cast<float>(b) - g.y()));
      }
  }

  // From far to near: each finer mean replaces the coarser one as far as there is path under it.
  double mean = 0;
  for (const auto& p : path) mean += static_cast<double>(p.z() - box.low.z());
  Grid height(n, static_cast<float>(mean / static_cast<double>(path.size())));
  for (int r = 64; r >= 2; r /= 2) {
    const Grid w = blurred(weight, size, r), s = blurred(sum, size, r);
    const float little =
        0.02f / static_cast<float>(r);  // a path of one sample a metre has about 0.4 / r
    for (std::size_t k = 0; k < n; ++k) height[k] = (s[k] + little * height[k]) / (w[k] + little);
  }

  for (int j = 0; j < size.rows; ++j)
    for (int i = 0; i < size.columns; ++i) {
      const float d = distance[size.at(i, j)];
      const float x = cell * static_cast<float>(i), y = cell * static_cast<float>(j);
      height[size.at(i, j)] +=
          box.low.z() + 0.12f * ramp(d, kerb - 0.5f, kerb + 0.5f) +
          unevenness * 0.05f * ramp(d, kerb - 1, kerb + 3) * bumps(x, y, 4, seed) +
          unevenness * 0.25f * ramp(d, kerb + 1, kerb + 4) * bumps(x, y, 17, seed + 1);
    }
  return {low, cell, size.columns, size.rows, std::move(height)};
}

}  // namespace plumb::simulate
