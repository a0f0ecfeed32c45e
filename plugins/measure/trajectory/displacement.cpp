#include "displacement.hpp"

#include <limits>

namespace plumb::measure_trajectory {

Eigen::Vector2d mean_displacement(const PosePairs& pairs) {
  if (pairs.size() == 0) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Pose T_truth_estimate = pairs.truth[0] * pairs.estimate[0].inverse();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    sum += (T_truth_estimate * pairs.estimate[k].translation - pairs.truth[k].translation)
               .head<2>()
               .cwiseAbs();
  return sum / static_cast<double>(pairs.size());
}

}  // namespace plumb::measure_trajectory
