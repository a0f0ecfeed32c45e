#pragma once
/// For tests of filters: a tunnel in which little tells how far one is along it.

#include <Eigen/Eigenvalues>
#include <vector>

#include "plumb/data/random.hpp"
#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb::pcl {

/// 40 m of floor and walls with true normals, and of every `nth` point one on a wall across.
inline Cloud tunnel(int count, int nth, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * random.uniform());
  };
  const auto add = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
    cloud.add(p);
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  };
  for (int k = 0; k < count; ++k) {
    const float x = uniform(-20, 20), y = uniform(-3, 3), z = uniform(0, 4);
    if (k % nth == 0)
      add({k % (2 * nth) == 0 ? 10.f : -10.f, y, z}, {1, 0, 0});
    else if (k % 2)
      add({x, y, 0}, {0, 0, 1});
    else
      add({x, y > 0 ? 3.f : -3.f, z}, {0, 1, 0});
  }
  return cloud;
}

inline std::size_t across(const Cloud& cloud) {
  std::size_t count = 0;
  for (const float x : cloud.nx) count += x > 0.5f;
  return count;
}

/// How well points to planes on this cloud fix the motion that they fix least: the least eigenvalue
/// of the sum of [p x n; n] [p x n; n]', p about the centroid by the mean distance from it.
inline double least_fixed(const Cloud& cloud) {
  const Eigen::Vector3d centre = centroid_of(cloud).cast<double>();
  double scale = 0;
  for (std::size_t k = 0; k < cloud.size(); ++k)
    scale += (cloud.point(k).cast<double>() - centre).norm() / static_cast<double>(cloud.size());
  Matrix6d sum = Matrix6d::Zero();
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3d p = (cloud.point(k).cast<double>() - centre) / scale,
                          n = cloud.normal(k).cast<double>();
    Vector6d row;
    row << p.cross(n), n;
    sum += row * row.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(sum, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Every `nth` point.
inline Cloud thinned(const Cloud& cloud, std::size_t nth) {
  std::vector<std::uint32_t> kept;
  for (std::size_t k = 0; k < cloud.size(); k += nth) kept.push_back(static_cast<std::uint32_t>(k));
  return select(cloud, kept);
}

}  // namespace plumb::pcl
