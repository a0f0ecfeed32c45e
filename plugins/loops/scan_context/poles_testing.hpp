#pragma once
/// For tests of what recognises places: a plain with poles of various heights.

#include <cmath>
#include <numbers>
#include <vector>

#include "plumb/data/random.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::loops_scan_context {

/// The poles' tips [m], on x from -60 to 260 and y from -60 to 60; the ground is at z = -2.
inline Cloud poles(std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (int k = 0; k < 900; ++k) {
    const double x = -60 + 320 * random.uniform(), y = -60 + 120 * random.uniform(),
                 height = 1 + 9 * random.uniform();
    cloud.add(Eigen::Vector3d(x, y, height - 2).cast<float>());
  }
  return cloud;
}

/// The poles within 45 m as a sensor sees them from a pose.
inline Segment seen_from(const Cloud& world, const Pose& T_world_segment) {
  Cloud cloud;
  const Pose back = T_world_segment.inverse();
  for (std::size_t k = 0; k < world.size(); ++k) {
    const Eigen::Vector3d p = back * world.point(k).cast<double>().eval();
    if (p.norm() < 45) cloud.add(p.cast<float>());
  }
  std::vector<std::uint16_t> frames(cloud.size(), 0);
  return Segment().with(std::move(cloud), std::move(frames));
}

inline Pose standing(double x, double y, double heading) {
  return {exp_rotation({0, 0, heading}), {x, y, 0}};
}

/// Segments every 10 m along x, `count` of them, and as many on the way back beside it.
inline std::vector<Pose> out_and_back(int count) {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) poses.push_back(standing(10 * k, 0, 0));
  for (int k = count - 1; k >= 0; --k) poses.push_back(standing(10 * k, 0.5, std::numbers::pi));
  return poses;
}

}  // namespace plumb::loops_scan_context
