#pragma once
/// For tests of what registers segments: a yard with houses, low walls and poles, as points with
/// normals.

#include <random>
#include <vector>

#include "plumb/slam/cloud_testing.hpp"

namespace plumb::register_features {

struct Block {
  Eigen::Vector3d low, high;  ///< [m]
};

inline const std::vector<Block>& yard_blocks() {
  static const std::vector<Block> blocks = {
      {{5, 4, 0}, {15, 10, 5}},       {{-14, 6, 0}, {-6, 11, 4}},     {{-3, -12, 0}, {1, -6, 3}},
      {{8, -9, 0}, {12, -5, 2}},      {{-12, -8, 0}, {-9, -6, 2.5}},  {{-4, 12, 0}, {3, 12.4, 2}},
      {{16, -3, 0}, {16.3, -2.7, 6}}, {{-17, 1, 0}, {-16.7, 1.3, 6}}, {{2, 1, 0}, {2.3, 1.3, 5}},
      {{-6, -2, 0}, {-5.7, -1.7, 5}}, {{5, -13, 0}, {14, -12.7, 2}}};
  return blocks;
}

/// Points [m] on a rectangle spanned by u and v from `corner`, `per_square_metre`, displaced along
/// the normal u x v by `noise`.
inline void add_rectangle(Cloud& cloud, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                          const Eigen::Vector3d& v, double per_square_metre, double noise,
                          std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> error(0, 1);
  const Eigen::Vector3d normal = u.cross(v).normalized();
  for (int k = 0, n = static_cast<int>(u.cross(v).norm() * per_square_metre + 0.5); k < n; ++k) {
    const double a = share(random), b = share(random);
    cloud.add((corner + a * u + b * v + noise * error(random) * normal).cast<float>());
    cloud.nx.push_back(static_cast<float>(normal.x()));
    cloud.ny.push_back(static_cast<float>(normal.y()));
    cloud.nz.push_back(static_cast<float>(normal.z()));
  }
}

/// The four sides of a block, and its top.
inline void add_block(Cloud& cloud, const Block& block, double per_square_metre, double noise,
                      std::mt19937& random) {
  const Eigen::Vector3d size = block.high - block.low, x = size.x() * Eigen::Vector3d::UnitX(),
                        y = size.y() * Eigen::Vector3d::UnitY(),
                        z = size.z() * Eigen::Vector3d::UnitZ();
  add_rectangle(cloud, block.low, x, z, per_square_metre, noise, random);
  add_rectangle(cloud, block.low, z, y, per_square_metre, noise, random);
  add_rectangle(cloud, block.high, -z, -x, per_square_metre, noise, random);
  add_rectangle(cloud, block.high, -y, -z, per_square_metre, noise, random);
  add_rectangle(cloud, block.low + z, x, y, per_square_metre, noise, random);
}

/// The yard in world coordinates: each seed gives other points on the same surfaces.
inline Cloud yard(std::uint32_t seed, double noise = 0.02, double per_square_metre = 5) {
  std::mt19937 random(seed);
  Cloud cloud;
  for (const Block& block : yard_blocks()) add_block(cloud, block, per_square_metre, noise, random);
  add_rectangle(cloud, {-20, -15, 0}, {40, 0, 0}, {0, 30, 0}, per_square_metre, noise, random);
  return cloud;
}

inline Cloud moved(const Cloud& cloud, const Pose& pose) {
  const Motion motion(pose);
  Cloud result;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    result.add(motion * cloud.point(k));
    const Eigen::Vector3f normal = motion.r * cloud.normal(k);
    result.nx.push_back(normal.x());
    result.ny.push_back(normal.y());
    result.nz.push_back(normal.z());
  }
  return result;
}

/// The world's points as a segment that stands at T_world_segment.
inline Segment seen_from(const Pose& T_world_segment, const Cloud& world) {
  return segment_of(moved(world, T_world_segment.inverse()));
}

}  // namespace plumb::register_features
