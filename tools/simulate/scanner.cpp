#include "simulate/scanner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/random.hpp"

namespace plumb::simulate {

Scanner::Scanner(const ScannerOptions& options, std::uint64_t seed)
    : options_(options), seed_(seed) {
  directions_.reserve(static_cast<std::size_t>(options.lines) *
                      static_cast<std::size_t>(options.columns));
  for (int column = 0; column < options.columns; ++column) {
    const double azimuth =
        -2 * std::numbers::pi * column / options.columns;  // clockwise from ahead
    for (int line = 0; line < options.lines; ++line) {
      const double share =
          options.lines == 1 ? 0.5 : static_cast<double>(line) / (options.lines - 1);
      const double elevation = options.lowest + share * (options.highest - options.lowest);
      directions_.push_back(Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                            std::cos(elevation) * std::sin(azimuth),
                                            std::sin(elevation))
                                .cast<float>());
    }
  }
}

Cloud Scanner::scan(const World& world, const Pose& T_world_sensor, std::uint64_t frame) const {
  constexpr float dimmest = 0.1f;
  const auto range = static_cast<float>(options_.range), noise = static_cast<float>(options_.noise);
  const Eigen::Matrix3f turn = T_world_sensor.matrix().cast<float>();
  Fan fan;
  fan.origin = (T_world_sensor.translation - world.origin()).cast<float>();
  Cloud cloud;
  cloud.reserve(directions_.size());
  cloud.intensity.reserve(directions_.size());
  for (std::size_t first = 0; first < directions_.size(); first += lane_count) {
    const std::size_t count = std::min<std::size_t>(lane_count, directions_.size() - first);
    for (std::size_t lane = 0; lane < lane_count;
         ++lane)  // the last fan may be short: its last ray again
      fan.directions[lane] = turn * directions_[first + std::min(lane, count - 1)];
    const Hits hits = world.cast(fan, range);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const Hit& hit = hits[lane];
      if (!(hit.t <= range)) continue;
      const float light = hit.reflectance * std::abs(hit.normal.dot(fan.directions[lane]));
      if (light * range * range < dimmest * hit.t * hit.t) continue;
      const std::size_t k = first + lane;
      const float measured = std::max(0.01f, hit.t + noise * normal(mix(seed_, frame, k)));
      cloud.add(measured * directions_[k]);
      cloud.intensity.push_back(std::min(255.0f, 255 * light));
    }
  }
  return cloud;
}

}  // namespace plumb::simulate
