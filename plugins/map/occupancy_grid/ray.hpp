#pragma once
/// Which cells of a grid a ray passes, row by row.

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace plumb::map_occupancy_grid {

/// A ray in the plane, in units of cells: cell (c, r) covers [c, c+1) x [r, r+1). Coordinates are
/// not negative.
struct Ray {
  float x0, y0, x1, y1;
  std::int32_t first_row() const { return static_cast<std::int32_t>(std::min(y0, y1)); }
  std::int32_t last_row() const { return static_cast<std::int32_t>(std::max(y0, y1)); }
};

/// Calls run(row, first_column, last_column) for each row of `rows_from` to `rows_to` that the ray
/// passes, in order. Together the runs are exactly the cells that the ray passes (but for rounding
/// at corners); a row's run is the same whatever rows are asked for.
template <class Run>
void traverse(const Ray& ray, std::int32_t rows_from, std::int32_t rows_to, Run&& run) {
  const bool upward = ray.y0 <= ray.y1;
  const float xa = upward ? ray.x0 : ray.x1, ya = upward ? ray.y0 : ray.y1;
  const float xb = upward ? ray.x1 : ray.x0, yb = upward ? ray.y1 : ray.y0;
  const auto bottom = static_cast<std::int32_t>(ya), top = static_cast<std::int32_t>(yb);
  const float left = std::min(xa, xb), right = std::max(xa, xb);
  const float slope = bottom == top ? 0.0f : (xb - xa) / (yb - ya);
  // Where the ray crosses the lower border of row r.
  const auto crossing = [&](std::int32_t r) {
    return std::clamp(xa + (static_cast<float>(r) - ya) * slope, left, right);
  };
  const std::int32_t from = std::max(bottom, rows_from), to = std::min(top, rows_to);
  if (from > to) return;
  float low = from == bottom ? xa : crossing(from);
  for (std::int32_t r = from; r <= to; ++r) {
    const float high = r == top ? xb : crossing(r + 1);
    run(r, static_cast<std::int32_t>(std::min(low, high)),
        static_cast<std::int32_t>(std::max(low, high)));
    low = high;
  }
}

}  // namespace plumb::map_occupancy_grid
