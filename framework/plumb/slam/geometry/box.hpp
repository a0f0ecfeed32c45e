#pragma once
/// Axis-aligned boxes, and how far a moved box reaches: what prunes pairs of clouds before a point
/// is read.

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// An axis-aligned box [m]; empty until a point is added.
struct Box {
  static constexpr float beyond = std::numeric_limits<float>::infinity();
  Eigen::Vector3f low{beyond, beyond, beyond};
  Eigen::Vector3f high{-beyond, -beyond, -beyond};

  bool empty() const { return low.x() > high.x(); }
  void add(const Eigen::Vector3f& p) {
    for (int k = 0; k < 3; ++k) {
      low(k) = std::min(low(k), p(k));
      high(k) = std::max(high(k), p(k));
    }
  }
  Eigen::Vector3f centre() const;
  bool meets(const Box& other, float margin = 0) const;
};

/// The smallest axis-aligned box round `box` after the motion `T_a_b` (box given in b, result in
/// a).
Box moved(const Box& box, const Pose& T_a_b);

}  // namespace plumb
