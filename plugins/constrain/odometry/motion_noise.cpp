#include "motion_noise.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/slam/registration.hpp"
#include "shared/selection/median.hpp"

namespace plumb::constrain_odometry {
namespace {

Vector6d expected_sigma(const Pose& motion, const MotionNoise& noise) {
  const double path = motion.translation.norm();
  const double translation =
      std::hypot(noise.min_translation_sigma, noise.translation_per_metre * path);
  const double rotation = std::sqrt(std::pow(noise.min_rotation_sigma, 2) +
                                    std::pow(noise.rotation_per_metre * path, 2) +
                                    std::pow(noise.rotation_per_turn * angle(motion), 2));
  Vector6d sigma;
  sigma << translation, translation, translation, rotation, rotation, rotation;
  return sigma;
}

Vector6d difference(const Pose& a, const Pose& b) {
  const Pose d = a.inverse() * b;
  Vector6d v;
  v << d.translation, log_rotation(d.rotation);
  return v;
}

}  // namespace

OdometryNoise odometry_noise(const Poses& odometry, const Poses* registered,
                             const MotionNoise& noise, double max_factor, double max_deviation) {
  OdometryNoise result;
  const std::size_t n = odometry.size() > 0 ? odometry.size() - 1 : 0;
  std::vector<Vector6d> differences;
  for (std::size_t k = 0; k < n; ++k) {
    const Pose motion = odometry.relative(k, k + 1);
    result.motions.push_back({motion, expected_sigma(motion, noise)});
    if (registered) differences.push_back(difference(motion, registered->relative(k, k + 1)));
  }
  if (!registered || n == 0) return result;
  constexpr double normal =
      1.4826;  // of a normal distribution: deviation / median of absolute values
  for (int axis = 0; axis < 6; ++axis) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < n; ++k)
      ratios.push_back(std::abs(differences[k][axis]) / result.motions[k].sigma[axis]);
    result.factor[axis] =
        std::clamp(normal * selection::median(ratios), 1 / max_factor, max_factor);
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    Vector6d& sigma = result.motions[k].sigma;
    sigma = sigma.cwiseProduct(result.factor);
    const Vector6d ratio = differences[k].cwiseAbs().cwiseQuotient(sigma);
    if (ratio.maxCoeff() <= max_deviation) continue;
    result.outliers.push_back(k);
    sigma = sigma.cwiseMax(differences[k].cwiseAbs());
    sigma.head<3>().setConstant(sigma.head<3>().maxCoeff());
    sigma.tail<3>().setConstant(sigma.tail<3>().maxCoeff());
  }
  return result;
}

Constraints constraints_from(const std::vector<Motion6>& motions) {
  Constraints constraints;
  for (std::uint32_t k = 0; k < motions.size(); ++k) {
    const Matrix6d information = motions[k].sigma.array().square().inverse().matrix().asDiagonal();
    constraints.relative.push_back(
        constraint_of({k, k + 1, EdgeKind::sequential, 1, 0}, motions[k].T_k_next, information));
  }
  return constraints;
}

}  // namespace plumb::constrain_odometry
