#include "simulate/laser_2d.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulate/random.hpp"

namespace plumb::simulate {
namespace {

using Eigen::Vector2d;

constexpr double turn = 2 * std::numbers::pi;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The least distance from the origin to the wall's ends and foot.
double nearest(const Wall& wall, const Vector2d& origin) {
  const Vector2d along = wall.b - wall.a;
  const double share = std::clamp((origin - wall.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (wall.a + share * along - origin).norm();
}

}  // namespace

double distance_to(const Wall& wall, const Vector2d& origin, const Vector2d& direction) {
  const Vector2d along = wall.b - wall.a, to = wall.a - origin;
  const double sine = cross(direction, along);
  if (sine == 0) return std::numeric_limits<double>::infinity();  // along the wall: seen on edge
  const double t = cross(to, along) / sine, share = cross(to, direction) / sine;
  constexpr double slit = 1e-9;  // no beam slips between walls that meet
  return t >= 0 && share >= -slit && share <= 1 + slit ? t
                                                       : std::numeric_limits<double>::infinity();
}

Laser2d::Laser2d(const Laser2dOptions& options, std::uint64_t seed)
    : options_(options), seed_(seed), first_(-0.5 * options.field_of_view) {
  const bool full_circle = options.field_of_view > turn - 1e-9;
  step_ = options.field_of_view /
          static_cast<double>(full_circle ? options.columns : options.columns - 1);
}

std::vector<double> Laser2d::exact(const std::vector<Wall>& walls, const PlanarPose& pose) const {
  const auto beams = static_cast<std::size_t>(options_.columns);
  const Vector2d origin(pose.x, pose.y);
  std::vector<Vector2d> directions(beams);
  for (std::size_t k = 0; k < beams; ++k) {
    const double angle = pose.yaw + first_ + step_ * static_cast<double>(k);
    directions[k] = {std::cos(angle), std::sin(angle)};
  }
  std::vector<double> ranges(beams, options_.range);
  for (const Wall& wall : walls) {
    if (nearest(wall, origin) > options_.range) continue;
    // The beams between the wall's ends, counted from beam 0, and one more on either side.
    const double a = std::atan2(wall.a.y() - pose.y, wall.a.x() - pose.x);
    const double b = std::atan2(wall.b.y() - pose.y, wall.b.x() - pose.x);
    const double width = planar::wrapped(b - a);
    double from = (width > 0 ? a : b) - pose.yaw - first_;
    from -= turn * std::floor(from / turn);
    for (const double start : {from - turn, from}) {
      const double low = std::ceil(start / step_) - 1;
      const double high = std::floor((start + std::abs(width)) / step_) + 1;
      if (high < 0 || low >= static_cast<double>(beams)) continue;
      const auto last = static_cast<std::size_t>(std::min(high, static_cast<double>(beams - 1)));
      for (auto k = static_cast<std::size_t>(std::max(low, 0.0)); k <= last; ++k)
        ranges[k] = std::min(ranges[k], distance_to(wall, origin, directions[k]));
    }
  }
  return ranges;
}

std::vector<double> Laser2d::scan(const std::vector<Wall>& walls, const PlanarPose& pose,
                                  std::uint64_t index) const {
  std::vector<double> ranges = exact(walls, pose);
  for (std::size_t k = 0; k < ranges.size(); ++k)
    if (ranges[k] < options_.range)
      ranges[k] =
          std::clamp(ranges[k] + options_.noise * static_cast<double>(normal(mix(seed_, index, k))),
                     0.001, options_.range);
  return ranges;
}

}  // namespace plumb::simulate
