#pragma once
/// For tests: a street, and a drive through it by a scanner.

#include <algorithm>
#include <random>

#include "divergence.hpp"
#include "plumb/slam/values.hpp"

namespace plumb::check_odometry {

inline constexpr double degree = M_PI / 180;

// ---- a street, as a scanner sees it that is driven through it
// ---------------------------------------------------------------

struct Block {
  Eigen::Vector3d low, high;  ///< [m]
};

/// Houses with gaps on both sides, parked cars and poles, along x from -40 m to 160 m.
inline std::vector<Block> street(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Block> blocks;
  for (const double side : {-1.0, 1.0}) {
    for (double x = -40; x < 160;) {
      const double length = 4 + 6 * u(random), from = 5 + 3 * u(random), to = from + 10,
                   height = 5 + 6 * u(random);
      blocks.push_back({{x, std::min(side * from, side * to), -2},
                        {x + length, std::max(side * from, side * to), height}});
      x += length + 1 + 2 * u(random);
    }
    for (double x = -40; x < 160; x += 6 + 4 * u(random)) {
      const double y = side * (3.5 + u(random));
      blocks.push_back({{x, y, -2}, {x + 0.3, y + 0.3, 6}});
    }
    for (double x = -38; x < 160; x += 8 + 6 * u(random)) {
      const double y = side * 2.8 - 0.9;
      blocks.push_back({{x, y, -2}, {x + 4.5, y + 1.8, -0.4}});
    }
  }
  return blocks;
}

/// How far along `direction` a ray from `origin` meets the block; beyond all if it does not.
inline double range_to(const Block& block, const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& direction) {
  double enter = 0, leave = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (block.low[axis] - origin[axis]) / direction[axis],
                 b = (block.high[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : 1e9;
}

/// 3,500 rays in any direction between 30 degrees down and 25 up, up to 25 m, with 2 cm of noise;
/// the ground is 2 m below the sensor.
inline Cloud scan(const std::vector<Block>& blocks, const Pose& at, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> azimuth(-M_PI, M_PI),
      height(std::sin(-30 * degree), std::sin(25 * degree));
  std::vector<Block> near;
  for (const Block& block : blocks)
    if (block.low.x() < at.translation.x() + 30 && block.high.x() > at.translation.x() - 30)
      near.push_back(block);
  Cloud cloud;
  for (int k = 0; k < 3500; ++k) {
    const double round = azimuth(random), up = height(random), level = std::sqrt(1 - up * up);
    const Eigen::Vector3d ray(level * std::cos(round), level * std::sin(round), up),
        direction = at.rotation * ray;
    double range = direction.z() < 0 ? (-2 - at.translation.z()) / direction.z() : 1e9;
    for (const Block& block : near)
      range = std::min(range, range_to(block, at.translation, direction));
    if (range < 25) cloud.add(((range + noise(random)) * ray).cast<float>());
  }
  return cloud;
}

struct Drive {
  Trajectory truth;
  std::vector<Frame> frames;
};

/// 36 frames, `step` [m] apart but for a stop, swinging gently from one side of the street to the
/// other.
inline Drive drive_of(double step, std::uint32_t stop_from = 0, std::uint32_t stop_to = 0) {
  Drive d;
  std::mt19937 random(1);
  const auto blocks = street(1);
  double x = 0;
  for (std::uint32_t k = 0; k < 36; ++k) {
    if (k > 0 && (k <= stop_from || k > stop_to)) x += step;
    const Pose pose(exp_rotation({0, 0, std::atan(0.1 * std::cos(0.1 * x))}),
                    {x, std::sin(0.1 * x), 0});
    d.truth.stamps.push_back(100 + 0.1 * k);
    d.truth.T_world_frame.push_back(pose);
    d.frames.push_back({k, scan(blocks, pose, random)});
  }
  return d;
}
inline const Drive& drive() {
  static const Drive made = drive_of(0.6);
  return made;
}
inline const Drive& slow_drive() {
  static const Drive made = drive_of(0.4);
  return made;
}

/// The trajectory with other motions: change(k, motion from frame k to k + 1).
template <class Change>
inline Trajectory changed(const Trajectory& truth, const Change& change) {
  Trajectory odometry = truth;
  for (std::uint32_t k = 0; k + 1 < truth.size(); ++k)
    odometry.T_world_frame[k + 1] =
        odometry.T_world_frame[k] *
        change(k, truth.T_world_frame[k].inverse() * truth.T_world_frame[k + 1]);
  return odometry;
}

inline Pose scaled(const Pose& motion, double factor) {
  return {exp_rotation(factor * log_rotation(motion.rotation)), factor * motion.translation};
}

}  // namespace plumb::check_odometry
