#pragma once
/// For tests of clouds and of what is made of them.

#include <cmath>

#include "plumb/slam/cloud.hpp"

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

}  // namespace plumb
