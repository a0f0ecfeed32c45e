#pragma once
/// For tests of clouds and of what is made of them.

#include <cmath>
#include <utility>

#include "plumb/data/random.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb {

/// `count` points with all arrays, no two alike.
inline Cloud full_cloud(std::size_t count) {
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    const float f = static_cast<float>(k);
    cloud.add({0.1f + f, -2.5f * f, 1e-3f * f * f});
    cloud.intensity.push_back(100 + f / 3);
    cloud.time.push_back(1e-4f * f);
    cloud.ring.push_back(static_cast<std::uint16_t>(40000 + k));
    cloud.nx.push_back(std::cos(f));
    cloud.ny.push_back(std::sin(f));
    cloud.nz.push_back(0);
  }
  return cloud;
}

/// A point of the cube round the origin whose edges are twice `half` [m].
inline Eigen::Vector3f in_cube(Random& random, float half) {
  return {half * static_cast<float>(2 * random.uniform() - 1),
          half * static_cast<float>(2 * random.uniform() - 1),
          half * static_cast<float>(2 * random.uniform() - 1)};
}

/// A segment of one frame, which saw the cloud.
inline Segment segment_of(Cloud cloud) {
  Segment segment;
  segment.range.end = 1;
  segment.range.T_segment_frame.resize(1);
  std::vector<std::uint16_t> frames(cloud.size(), 0);
  return segment.with(std::move(cloud), std::move(frames));
}

}  // namespace plumb
