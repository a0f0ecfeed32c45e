#include "scan_pair.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "plumb/slam/geometry/search_tree.hpp"
#include "plumb/slam/geometry/symmetric.hpp"
#include "shared/selection/evenly.hpp"
#include "shared/thinning/voxel_means.hpp"

namespace plumb::check_odometry {
namespace {

Cloud thinned(const Cloud& scan, double voxel_size) {
  thinning::VoxelMeans means(voxel_size);
  Cloud points;
  points.x = scan.x, points.y = scan.y, points.z = scan.z;
  means.add(points, {}, {});
  return means.take().cloud;
}

}  // namespace

struct ScanTarget::State {
  State(const Cloud& scan, const ScanOptions& of)
      : options(of),
        cloud(thinned(scan, of.voxel_size)),
        tree(cloud),
        normals(cloud.size(), Eigen::Vector3f::Zero()),
        known(cloud.size(), false) {}

  const Eigen::Vector3f& normal(std::uint32_t k) {
    if (known[k]) return normals[k];
    known[k] = true;
    constexpr std::size_t count = 12;
    SearchTree::Neighbour near[count];
    const std::size_t n = tree.nearest(cloud.point(k), count, near);
    if (n < 5) return normals[k];
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (std::size_t i = 0; i < n; ++i) mean += cloud.point(near[i].index);
    mean /= static_cast<float>(n);
    Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3f d = cloud.point(near[i].index) - mean;
      scatter.noalias() += d * d.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
    eigen.computeDirect(scatter);
    return normals[k] = eigen.eigenvectors().col(0);
  }

  ScanOptions options;
  Cloud cloud;
  SearchTree tree;
  std::vector<Eigen::Vector3f> normals;
  std::vector<bool> known;
};

ScanTarget::ScanTarget(const Cloud& scan, const ScanOptions& options)
    : state_(std::make_unique<State>(scan, options)) {}
ScanTarget::~ScanTarget() = default;
ScanTarget::ScanTarget(ScanTarget&&) noexcept = default;

double ScanTarget::misfit(const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source) {
  State& s = *state_;
  const auto most = static_cast<float>(s.options.max_distance);
  if (source.empty() || s.cloud.empty()) return s.options.max_distance;
  const Motion motion(T_target_source);
  double sum = 0;
  for (const auto& point : source) {
    const Eigen::Vector3f at = motion * point;
    SearchTree::Neighbour nearest;
    if (!s.tree.nearest_within(at, most, nearest)) {
      sum += most;
      continue;
    }
    const Eigen::Vector3f& normal = s.normal(nearest.index);
    sum += normal.isZero() ? std::sqrt(nearest.squared_distance)
                           : std::abs(normal.dot(at - s.cloud.point(nearest.index)));
  }
  return sum / static_cast<double>(source.size());
}

Pose ScanTarget::aligned(const std::vector<Eigen::Vector3f>& source, Pose T) {
  State& s = *state_;
  for (std::uint32_t k = 0; k < s.options.iterations; ++k) {
    // Begins with twice the distance: half of the iterations to find the way, half to settle.
    const double max =
        2 * k < s.options.iterations ? 2 * s.options.max_distance : s.options.max_distance;
    const Motion motion(T);
    const Eigen::Matrix3d R = T.matrix();
    Matrix6d h = 1e-3 * Matrix6d::Identity();
    Vector6d g = Vector6d::Zero();
    for (const auto& point : source) {
      const Eigen::Vector3f at = motion * point;
      SearchTree::Neighbour nearest;
      if (!s.tree.nearest_within(at, static_cast<float>(max), nearest)) continue;
      const Eigen::Vector3f& normal = s.normal(nearest.index);
      const double r = static_cast<double>(normal.dot(at - s.cloud.point(nearest.index)));
      const Eigen::Vector3d n = normal.cast<double>();
      const Eigen::Vector3d lever = point.cast<double>().cross(R.transpose() * n);
      Vector6d row;
      for (int axis = 0; axis < 3; ++axis) row[axis] = n[axis], row[3 + axis] = lever[axis];
      const double w = 1 / (1 + r * r / (0.04 * max * max));
      h.noalias() += w * row * row.transpose();
      g.noalias() += w * r * row;
    }
    const Vector6d step = -solve_symmetric(h, g);
    T = {(T.rotation * exp_rotation(Eigen::Vector3d(step[3], step[4], step[5]))).normalized(),
         T.translation + Eigen::Vector3d(step[0], step[1], step[2])};
    if (step.norm() < 1e-4) break;
  }
  return T;
}

std::vector<Eigen::Vector3f> asked_points(const Cloud& scan, const ScanOptions& options) {
  const Cloud cloud = thinned(scan, options.voxel_size);
  std::vector<Eigen::Vector3f> points;
  for (const auto k : selection::evenly(cloud.size(), options.max_points))
    points.push_back(cloud.point(k));
  return points;
}

}  // namespace plumb::check_odometry
