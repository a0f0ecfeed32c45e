#include "plumb/slam/geometry/box.hpp"

namespace plumb {

Eigen::Vector3f Box::centre() const { return 0.5f * (low + high); }

bool Box::meets(const Box& other, float margin) const {
  return !empty() && !other.empty() && (low.array() - margin <= other.high.array()).all() &&
         (other.low.array() - margin <= high.array()).all();
}

Box moved(const Box& box, const Pose& T_a_b) {
  Box result;
  if (box.empty()) return result;
  const Motion motion(T_a_b);
  const Eigen::Vector3f half = 0.5f * (box.high - box.low);
  const Eigen::Vector3f centre = motion * box.centre();
  const Eigen::Vector3f reach = motion.r.cwiseAbs() * half;
  result.low = centre - reach;
  result.high = centre + reach;
  return result;
}

}  // namespace plumb
