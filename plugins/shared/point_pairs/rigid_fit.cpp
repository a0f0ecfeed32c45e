#include "shared/point_pairs/rigid_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace plumb::point_pairs {

Pose rigid_fit(std::span<const Eigen::Vector3f> from, std::span<const Eigen::Vector3f> to,
               std::span<const std::uint32_t> pairs, std::span<const double> weights) {
  const auto weight = [&](std::size_t n) { return weights.empty() ? 1.0 : weights[n]; };
  Eigen::Vector3d mean_from = Eigen::Vector3d::Zero(), mean_to = Eigen::Vector3d::Zero();
  double total = 0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    mean_from += weight(n) * from[pairs[n]].cast<double>();
    mean_to += weight(n) * to[pairs[n]].cast<double>();
    total += weight(n);
  }
  mean_from /= total;
  mean_to /= total;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const Eigen::Vector3d off = weight(n) * (to[pairs[n]].cast<double>() - mean_to);
    covariance += off * (from[pairs[n]].cast<double>() - mean_from).transpose();
  }
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
