#pragma once
/// Axis-aligned boxes, and how far a moved box reaches: what prunes pairs of clouds before a point
/// is read.

#include <Eigen/Core>
#include <limits>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// An axis-aligned box [m]; empty until a point is added.
struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Vector3f high = Eigen::Vector3f::Constant(-std::numeric_limits<float>::infinity());

  bool empty() const { return low.x() > high.x(); }
  void add(const Eigen::Vector3f& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Eigen::Vector3f centre() const { return 0.5f * (low + high); }
  bool meets(const Box& other, float margin = 0) const {
    return !empty() && !other.empty() && (low.array() - margin <= other.high.array()).all() &&
           (other.low.array() - margin <= high.array()).all();
  }
};

/// The smallest axis-aligned box round `box` after the motion `T_a_b` (box given in b, result in
/// a).
inline Box moved(const Box& box, const Pose& T_a_b) {
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
