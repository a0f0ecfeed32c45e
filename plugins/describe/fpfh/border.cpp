#include "border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb::describe_fpfh {
namespace {

constexpr int sectors = 32;  // 8 a quadrant, each at most 14.1 degrees wide

/// Rises with the angle of (a, b) from 0 to 4, by 1 a quadrant: |b| / (|a| + |b|) and its mirrors.
float turn(float a, float b) {
  const float t = b / (std::abs(a) + std::abs(b));
  if (a < 0) return 2 - t;
  return b < 0 ? 4 + t : t;
}

/// The angle [rad] that has this turn.
double angle_of(float turn) {
  const double quadrant = std::floor(turn), t = turn - quadrant;
  return std::numbers::pi / 2 * quadrant + std::atan2(t, 1 - t);
}

}  // namespace

double largest_gap(const Oriented& point, const Candidates& candidates, float squared_radius) {
  const Eigen::Vector3f normal(point.nx, point.ny, point.nz);
  const Eigen::Vector3f u = normal.unitOrthogonal(), v = normal.cross(u);
  // Of each sector the first and the last direction; only gaps across an empty sector can be wide.
  std::array<float, sectors> first, last;
  first.fill(std::numeric_limits<float>::infinity());
  last.fill(-1);
  for (std::size_t k = 0; k < candidates.size; ++k) {
    const float dx = candidates.x[k] - point.x, dy = candidates.y[k] - point.y,
                dz = candidates.z[k] - point.z;
    if (!((dx * dx + dy * dy) + dz * dz <= squared_radius)) continue;
    const float a = u.x() * dx + u.y() * dy + u.z() * dz, b = v.x() * dx + v.y() * dy + v.z() * dz;
    if (a == 0 && b == 0) continue;
    const float t = turn(a, b);
    const int sector = std::clamp(static_cast<int>(t * (sectors / 4)), 0, sectors - 1);
    first[sector] = std::min(first[sector], t);
    last[sector] = std::max(last[sector], t);
  }

  int begin = 0;
  while (begin < sectors && last[begin] < 0) ++begin;
  if (begin == sectors) return 2 * std::numbers::pi;
  double widest = 0;
  int previous = begin;
  for (int step = 1; step <= sectors; ++step) {
    const int sector = (begin + step) % sectors;
    if (last[sector] < 0) continue;
    if (begin + step > previous + 1 || step == sectors) {
      double gap = angle_of(first[sector]) - angle_of(last[previous % sectors]);
      if (begin + step >= sectors && gap <= 0) gap += 2 * std::numbers::pi;
      widest = std::max(widest, gap);
    }
    previous = begin + step;
  }
  return widest;
}

}  // namespace plumb::describe_fpfh
