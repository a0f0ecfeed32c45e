#pragma once
/// For tests of steps that call PCL: a street corner, motions of it, segments.

#include <cmath>
#include <utility>
#include <vector>

#include "plumb/data/random.hpp"
#include "plumb/slam/geometry/pose.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::pcl {

/// Ground, two facades, a pillar and a ball within 12 m, `noise` [m] off at most, with true
/// normals.
inline Cloud street_corner(std::size_t count, std::uint64_t seed, float noise = 0.02f) {
  Random random(seed);
  Cloud cloud;
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  const auto add = [&](Eigen::Vector3f p, const Eigen::Vector3f& n) {
    for (int c = 0; c < 3; ++c) p[c] += noise * uniform(-1, 1);
    cloud.add(p);
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double part = random.uniform();
    const float turn = uniform(0, 6.2831853), high = uniform(-1, 1);
    const float flat = std::sqrt(1 - high * high);
    const Eigen::Vector3f round(std::cos(turn), std::sin(turn), 0);
    const Eigen::Vector3f ball(flat * round.x(), flat * round.y(), high);
    const float a = uniform(0, 12), b = uniform(0, 12), up = uniform(0, 5);
    if (part < 0.5)
      add({a, b, 0}, {0, 0, 1});
    else if (part < 0.7)
      add({a, 0, up}, {0, 1, 0});
    else if (part < 0.9)
      add({0, b, up}, {1, 0, 0});
    else if (part < 0.95)
      add(Eigen::Vector3f(7, 4, 0.8f * up) + 0.4f * round, round);
    else
      add(Eigen::Vector3f(4, 8, 1.5f) + 1.5f * ball, ball);
  }
  return cloud;
}

/// The cloud in the coordinates that `T` maps its own to, normals too.
inline Cloud moved(const Cloud& cloud, const Pose& T) {
  const Motion motion(T);
  Cloud result = cloud;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f p = motion * cloud.point(k);
    result.x[k] = p.x(), result.y[k] = p.y(), result.z[k] = p.z();
    if (!cloud.has_normals()) continue;
    const Eigen::Vector3f n = motion.r * cloud.normal(k);
    result.nx[k] = n.x(), result.ny[k] = n.y(), result.nz[k] = n.z();
  }
  return result;
}

/// A segment of one frame.
inline Segment segment_of(Cloud cloud) {
  Segment segment;
  segment.range.end = 1;
  segment.range.T_segment_frame.resize(1);
  std::vector<std::uint16_t> frames(cloud.size(), 0);
  return segment.with(std::move(cloud), std::move(frames));
}

}  // namespace plumb::pcl
