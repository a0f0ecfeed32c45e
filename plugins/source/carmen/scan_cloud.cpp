#include "scan_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::source_carmen {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double longest = 200;  ///< [m]: no 2-D scanner of a robot sees farther
constexpr double shortest =
    3.9;  ///< [m]: no 2-D scanner of a robot sees less far (Hokuyo URG-04LX: 4.095 m)
constexpr double beside = 0.99;  ///< readings from this share of the maximum on are the maximum

/// Whether readings of `mm` millimetres come from beams all over the fan, not from a wall before a
/// standing robot.
bool all_over(const std::vector<LaserScan>& scans, std::size_t mm) {
  std::vector<bool> seen;
  std::size_t beams = 0;
  for (const LaserScan& scan : scans) {
    if (scan.ranges.size() > seen.size()) seen.resize(scan.ranges.size());
    for (std::size_t k = 0; k < scan.ranges.size(); ++k)
      if (!seen[k] && std::lround(scan.ranges[k] * 1000) == static_cast<long>(mm))
        seen[k] = true, ++beams;
  }
  return beams >= std::max<std::size_t>(3, seen.size() / 20);
}

}  // namespace

Fan fan_of(const LaserScan& scan, std::optional<double> field_of_view) {
  const auto n = static_cast<double>(scan.ranges.size());
  if (field_of_view) return {-*field_of_view / 2, n > 1 ? *field_of_view / (n - 1) : 0.0};
  if (scan.step > 0) return {scan.start, scan.step};
  switch (scan.ranges.size()) {
    case 180:
    case 181:
      return {-90 * degree, degree};
    case 360:
    case 361:
      return {-90 * degree, degree / 2};
    case 720:
    case 721:
      return {-90 * degree, degree / 4};
    case 540:
    case 541:
      return {-135 * degree, degree / 2};
    case 1080:
    case 1081:
      return {-135 * degree, degree / 4};
    default:
      return {-90 * degree, n > 1 ? 180 * degree / (n - 1) : 0.0, false};
  }
}

std::optional<double> repeated_maximum(const std::vector<LaserScan>& scans) {
  // Readings in millimetres: logs have them rounded to 1 or 10.
  std::vector<std::uint32_t> readings(static_cast<std::size_t>(longest * 1000) + 1, 0);
  std::uint64_t all = 0;
  for (const LaserScan& scan : scans)
    for (const float range : scan.ranges)
      if (range > 0 && range <= longest)
        ++readings[static_cast<std::size_t>(std::lround(range * 1000))], ++all;
  const double many = std::max(3.0, 1e-4 * static_cast<double>(all));
  std::uint64_t above = 0;
  for (std::size_t mm = readings.size(); mm-- > static_cast<std::size_t>(shortest * 1000);
       above += readings[mm]) {
    const double here = readings[mm];
    if (here < many) continue;
    // It is the end of what is seen, but for a few glitches, and sticks out of what is seen before
    // it.
    std::uint64_t before = 0;
    for (std::size_t k = mm * 90 / 100; k < mm * 99 / 100; ++k) before += readings[k];
    const bool end = static_cast<double>(above) <= here / 10,
               sticks_out = here * 9 > 3.0 * static_cast<double>(before);
    if (end && sticks_out && all_over(scans, mm)) return beside * static_cast<double>(mm) / 1000;
    return std::nullopt;
  }
  return std::nullopt;
}

Cloud cloud_of(const LaserScan& scan, const Fan& fan, const Limits& limits, LeftOut* left_out) {
  Cloud cloud;
  cloud.reserve(scan.ranges.size());
  LeftOut ignored;
  LeftOut& left = left_out ? *left_out : ignored;
  for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
    const double range = scan.ranges[k];
    if (std::isnan(range) || range < 0)
      ++left.no_number;
    else if (range < limits.low)
      ++left.too_near;
    else if (range >= limits.high)
      ++left.nothing_seen;
    else {
      const double angle = fan.start + static_cast<double>(k) * fan.step;
      cloud.add({static_cast<float>(range * std::cos(angle)),
                 static_cast<float>(range * std::sin(angle)), 0});
    }
  }
  return cloud;
}

Pose mounting_of(const std::vector<LaserScan>& scans, double offset) {
  const Pose by_parameter(Eigen::Quaterniond::Identity(), {offset, 0, 0});
  std::optional<Pose> first;
  for (const LaserScan& scan : scans) {
    if (!scan.laser || !scan.robot) return by_parameter;
    const Pose mounting = in_space(*scan.robot).inverse() * in_space(*scan.laser);
    if (!first) first = mounting;
    const Pose difference = first->inverse() * mounting;
    if (difference.translation.norm() > 5e-3 || angle(difference) > 0.1 * degree)
      return by_parameter;
  }
  return first.value_or(by_parameter);
}

}  // namespace plumb::source_carmen
