#include "plumb/slam/cloud.hpp"

namespace plumb {
namespace {

template <class T>
std::vector<T> picked(const std::vector<T>& from, const std::vector<std::uint32_t>& indices) {
  std::vector<T> result;
  if (from.empty()) return result;
  result.reserve(indices.size());
  for (const auto k : indices) result.push_back(from[k]);
  return result;
}

}  // namespace

Cloud select(const Cloud& cloud, const std::vector<std::uint32_t>& indices) {
  Cloud result;
  result.x = picked(cloud.x, indices);
  result.y = picked(cloud.y, indices);
  result.z = picked(cloud.z, indices);
  result.intensity = picked(cloud.intensity, indices);
  result.time = picked(cloud.time, indices);
  result.ring = picked(cloud.ring, indices);
  result.nx = picked(cloud.nx, indices);
  result.ny = picked(cloud.ny, indices);
  result.nz = picked(cloud.nz, indices);
  return result;
}

Box box_of(const Cloud& cloud) {
  Box box;
  for (std::size_t k = 0; k < cloud.size(); ++k) box.add(cloud.point(k));
  return box;
}

Eigen::Vector3f centroid_of(const Cloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < cloud.size(); ++k) sum += cloud.point(k).cast<double>();
  if (!cloud.empty()) sum /= static_cast<double>(cloud.size());
  return sum.cast<float>();
}

}  // namespace plumb
