#include "shared/neighbourhood/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace plumb::neighbourhood {
namespace {

constexpr std::size_t block_points = 1024;  // fixed, so that blocks do not follow the threads

}  // namespace

std::size_t write_normals(Cloud& cloud, const SearchTree& tree, const Bounds& bounds,
                          const std::function<Eigen::Vector3f(std::size_t)>& origin,
                          Context& context, const NormalOf& normal_of) {
  const std::size_t size = cloud.size();
  cloud.nx.assign(size, 0), cloud.ny.assign(size, 0), cloud.nz.assign(size, 0);
  const std::size_t blocks = (size + block_points - 1) / block_points;
  std::vector<std::size_t> without(blocks, 0);
  context.parallel(blocks, [&](std::size_t block) {
    Finder finder(cloud, tree, bounds);
    const std::size_t end = std::min(size, (block + 1) * block_points);
    for (std::size_t k = block * block_points; k < end; ++k) {
      Eigen::Vector3f normal = normal_of(finder.around(k));
      if (normal.isZero()) {
        ++without[block];
        continue;
      }
      if (normal.dot(origin(k) - cloud.point(k)) < 0) normal = -normal;
      cloud.nx[k] = normal.x(), cloud.ny[k] = normal.y(), cloud.nz[k] = normal.z();
    }
  });
  std::size_t sum = 0;
  for (const auto n : without) sum += n;
  return sum;
}

Eigen::Vector3f plane_normal(const Eigen::Vector3f* points, std::size_t count, double min_width,
                             double max_thickness) {
  if (count < 3) return Eigen::Vector3f::Zero();
  double x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (std::size_t m = 0; m < count; ++m) {
    const double px = points[m].x(), py = points[m].y(), pz = points[m].z();
    x += px, y += py, z += pz;
    xx += px * px, xy += px * py, xz += px * pz;
    yy += py * py, yz += py * pz, zz += pz * pz;
  }
  const double n = static_cast<double>(count);
  Eigen::Matrix3d covariance;
  covariance << xx - x * x / n, xy - x * y / n, xz - x * z / n,  //
      xy - x * y / n, yy - y * y / n, yz - y * z / n,            //
      xz - x * z / n, yz - y * z / n, zz - z * z / n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance);
  const auto& variances = eigen.eigenvalues();
  if (!(variances[1] > min_width * min_width * variances[2])) return Eigen::Vector3f::Zero();
  if (max_thickness < 1 && !(variances[0] <= max_thickness * max_thickness * variances[1]))
    return Eigen::Vector3f::Zero();
  return eigen.eigenvectors().col(0).normalized().cast<float>();
}

}  // namespace plumb::neighbourhood
