#include "shared/planar/line_normal.hpp"

#include <algorithm>
#include <cmath>

namespace plumb::planar {
namespace {

constexpr double most_across = 0.4;  // of a line's points: spread across it to spread along it

}  // namespace

Eigen::Vector3f line_normal(const Eigen::Vector3f* points, std::size_t count) {
  if (count < 3) return Eigen::Vector3f::Zero();
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t m = 0; m < count; ++m) {
    const double px = points[m].x(), py = points[m].y();
    x += px, y += py;
    xx += px * px, xy += px * py, yy += py * py;
  }
  const double n = static_cast<double>(count);
  const double a = xx - x * x / n, b = xy - x * y / n, c = yy - y * y / n;
  const double half = 0.5 * (a + c), root = std::sqrt(std::max(0.0, half * half - (a * c - b * b)));
  const double along = half + root, across = std::max(0.0, half - root);
  if (!(along > 0) || across > most_across * most_across * along) return Eigen::Vector3f::Zero();
  const double angle = 0.5 * std::atan2(2 * b, a - c);  // of the line
  return {static_cast<float>(-std::sin(angle)), static_cast<float>(std::cos(angle)), 0};
}

}  // namespace plumb::planar
