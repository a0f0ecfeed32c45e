#include "shared/point_pairs/rigid_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace plumb::point_pairs {

Pose rigid_fit(std::span<const Eigen::Vector3f> from, std::span<const Eigen::Vector3f> to,
               std::span<const std::uint32_t> pairs) {
  Eigen::Vector3d mean_from = Eigen::Vector3d::Zero(), mean_to = Eigen::Vector3d::Zero();
  for (const auto k : pairs) {
    mean_from += from[k].cast<double>();
    mean_to += to[k].cast<double>();
  }
  mean_from /= static_cast<double>(pairs.size());
  mean_to /= static_cast<double>(pairs.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto k : pairs)
    covariance +=
        (to[k].cast<double>() - mean_to) * (from[k].cast<double>() - mean_from).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  const Eigen::Matrix3d R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return {R, Eigen::Vector3d(mean_to - R * mean_from)};
}

std::vector<std::uint32_t> agreeing(std::span<const Eigen::Vector3f> from,
                                    std::span<const Eigen::Vector3f> to, const Pose& T_to_from,
                                    double max) {
  const Motion motion(T_to_from);
  const auto squared_max = static_cast<float>(max * max);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t k = 0; k < from.size(); ++k)
    if ((to[k] - motion * from[k]).squaredNorm() <= squared_max) kept.push_back(k);
  return kept;
}

}  // namespace plumb::point_pairs
