#pragma once
/// For tests of loops: a drive of two laps with the drift of a car's odometry, and its loops.

#include <random>
#include <vector>

#include "loop_consistency.hpp"
#include "plumb/slam/graph.hpp"

namespace plumb::prune_loop_consistency {

inline Eigen::Vector3d gauss3(std::mt19937& random, double sigma) {
  std::normal_distribution<double> g(0, sigma);
  const double x = g(random), y = g(random), z = g(random);
  return {x, y, z};
}

/// Two laps round a square of 4 x 12 segments, 10 m apart, with drift as a car's odometry has it.
struct Drive {
  Poses truth, drifted;
  static constexpr std::uint32_t lap = 48;
};

inline Drive two_laps(std::uint32_t seed, double drift = 1) {
  std::mt19937 random(seed);
  Drive drive;
  const Pose ahead(Eigen::Quaterniond::Identity(), {10, 0, 0}),
      corner(exp_rotation({0, 0, M_PI / 2}), {10, 0, 0});
  drive.truth.T_world_segment.resize(1);
  drive.drifted.T_world_segment.resize(1);
  const Eigen::Vector3d slow = gauss3(random, 0.0002 * drift);  // [rad/m], the same all the way
  for (std::uint32_t k = 1; k < 2 * Drive::lap; ++k) {
    const Pose& motion = k % 12 == 0 ? corner : ahead;
    const Pose error(exp_rotation(10 * slow + gauss3(random, 0.001 * drift)),
                     gauss3(random, 0.03 * drift));
    drive.truth.T_world_segment.push_back(drive.truth.T_world_segment.back() * motion);
    drive.drifted.T_world_segment.push_back(drive.drifted.T_world_segment.back() * motion * error);
  }
  return drive;
}

/// The loop that a registration of i and j gives where all is well.
inline Loop right_loop(const Drive& drive, std::uint32_t i, std::uint32_t j, std::mt19937& random) {
  return {
      i, j,
      drive.truth.relative(i, j) * Pose(exp_rotation(gauss3(random, 0.001)), gauss3(random, 0.03))};
}

/// From every second segment of the first lap to the second one.
inline std::vector<Loop> right_loops(const Drive& drive, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Loop> loops;
  for (std::uint32_t k = 0; k < Drive::lap; k += 2)
    loops.push_back(right_loop(drive, k, k + Drive::lap, random));
  return loops;
}

}  // namespace plumb::prune_loop_consistency
