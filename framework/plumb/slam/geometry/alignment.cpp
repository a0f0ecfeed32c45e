#include "plumb/slam/geometry/alignment.hpp"

#include <Eigen/SVD>

namespace plumb {

Pose align(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b) {
  if (a.empty()) return {};
  const double count = static_cast<double>(a.size());
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < a.size(); ++k) {
    mean_a += a[k];
    mean_b += b[k];
  }
  mean_a /= count;
  mean_b /= count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < a.size(); ++k)
    covariance += (b[k] - mean_b) * (a[k] - mean_a).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Where U V^T mirrors, the axis that matters least is turned round.
  const Eigen::Matrix3d& u = svd.matrixU();
  const double mirrors = (u * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Matrix3d r =
      u * Eigen::Vector3d(1, 1, mirrors).asDiagonal() * svd.matrixV().transpose();
  const Pose turned(r, Eigen::Vector3d::Zero());
  return {turned.rotation, mean_b - turned.rotation * mean_a};
}

}  // namespace plumb
