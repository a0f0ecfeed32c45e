#pragma once
/// A small street corner for tests: ground, two facades, a pillar and a ball, with true normals
/// that a little noise has turned.

#include <cmath>

#include "plumb/plugin/context.hpp"
#include "plumb/slam/cloud.hpp"

namespace plumb::describe_fpfh {

inline Cloud street_corner(std::size_t count, std::uint64_t seed, float noise = 0.02f) {
  Random random(seed);
  Cloud cloud;
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  const auto add = [&](Eigen::Vector3f p, Eigen::Vector3f n) {
    for (int c = 0; c < 3; ++c) {
      p[c] += noise * uniform(-1, 1);
      n[c] += 5 * noise * uniform(-1, 1);
    }
    n.normalize();
    cloud.add(p);
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double part = random.uniform();
    const float turn = uniform(0, 6.2831853), high = uniform(-1, 1),
                flat = std::sqrt(1 - high * high);
    const Eigen::Vector3f round(std::cos(turn), std::sin(turn), 0);
    const Eigen::Vector3f ball(flat * round.x(), flat * round.y(), high);
    if (part < 0.5)
      add({uniform(0, 12), uniform(0, 12), 0}, {0, 0, 1});
    else if (part < 0.7)
      add({uniform(0, 12), 0, uniform(0, 5)}, {0, 1, 0});
    else if (part < 0.9)
      add({0, uniform(0, 12), uniform(0, 5)}, {1, 0, 0});
    else if (part < 0.95)
      add(Eigen::Vector3f(7, 4, uniform(0, 4)) + 0.4f * round, round);
    else
      add(Eigen::Vector3f(4, 8, 1.5f) + 1.5f * ball, ball);
  }
  return cloud;
}

}  // namespace plumb::describe_fpfh
