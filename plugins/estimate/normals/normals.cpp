#include "normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace plumb::estimate_normals {
namespace {

constexpr std::size_t block_points = 1024;  // fixed, so that blocks do not follow the threads

/// Finds the neighbours of one point after another, in memory of its own.
class Finder {
 public:
  Finder(const Cloud& cloud, const SearchTree& tree, const Neighbourhood& of)
      : cloud_(cloud), tree_(tree), of_(of) {
    if (of.most) found_.resize(*of.most);
  }
  /// Neighbours of point k as seen from there.
  const std::vector<Eigen::Vector3f>& around(std::size_t k) {
    const Eigen::Vector3f here = cloud_.point(k);
    points_.clear();
    if (!here.allFinite()) return points_;
    std::size_t count;
    if (of_.most) {
      count = tree_.nearest(here, *of_.most, found_.data());
      if (of_.radius) {
        const auto r = static_cast<float>(*of_.radius);
        while (count > 0 && found_[count - 1].squared_distance > r * r) --count;
      }
    } else {
      tree_.within(here, static_cast<float>(*of_.radius), found_, false);
      count = found_.size();
    }
    for (std::size_t m = 0; m < count; ++m) points_.push_back(cloud_.point(found_[m].index) - here);
    return points_;
  }

 private:
  const Cloud& cloud_;
  const SearchTree& tree_;
  const Neighbourhood& of_;
  std::vector<SearchTree::Neighbour> found_;
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace

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

std::size_t estimate_normals(Cloud& cloud, const SearchTree& tree, const Neighbourhood& of,
                             const std::function<Eigen::Vector3f(std::size_t)>& origin,
                             Context& context) {
  const std::size_t size = cloud.size();
  cloud.nx.assign(size, 0), cloud.ny.assign(size, 0), cloud.nz.assign(size, 0);
  const std::size_t blocks = (size + block_points - 1) / block_points;
  std::vector<std::size_t> without(blocks, 0);
  context.parallel(blocks, [&](std::size_t block) {
    Finder finder(cloud, tree, of);
    const std::size_t end = std::min(size, (block + 1) * block_points);
    for (std::size_t k = block * block_points; k < end; ++k) {
      const auto& points = finder.around(k);
      Eigen::Vector3f normal =
          of.planar ? planar::line_normal(points.data(), points.size())
                    : plane_normal(points.data(), points.size(), of.min_width, of.max_thickness);
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

}  // namespace plumb::estimate_normals
