/// Rigid motions are a group, whatever the motions.
#include <rapidcheck/gtest.h>

#include "plumb/slam/geometry/pose.hpp"

namespace plumb {
namespace {

double in(double least, double most) {
  constexpr int steps = 1 << 20;
  return least + (most - least) * *rc::gen::inRange(0, steps) / steps;
}
Eigen::Vector3d vector(double most) { return {in(-most, most), in(-most, most), in(-most, most)}; }
Pose motion() { return {exp_rotation(vector(1.7)), vector(1000)}; }

bool close(const Pose& a, const Pose& b) {
  return angle(a.inverse() * b) < 1e-7 && (a.translation - b.translation).norm() < 1e-8;
}

RC_GTEST_PROP(PoseGroup, IsAssociative, ()) {
  const Pose a = motion(), b = motion(), c = motion();
  RC_ASSERT(close((a * b) * c, a * (b * c)));
}

RC_GTEST_PROP(PoseGroup, HasInverses, ()) {
  const Pose a = motion();
  RC_ASSERT(close(a * a.inverse(), Pose()));
  RC_ASSERT(close(a.inverse() * a, Pose()));
}

RC_GTEST_PROP(PoseGroup, ActsOnPoints, ()) {
  const Pose a = motion(), b = motion();
  const Eigen::Vector3d p = vector(100);
  RC_ASSERT(((a * b) * p - a * (b * p)).norm() < 1e-9);
}

RC_GTEST_PROP(Rotation, LogIsTheInverseOfExp, ()) {
  const Eigen::Vector3d w = vector(1.8);  // shorter than pi
  RC_ASSERT((log_rotation(exp_rotation(w)) - w).norm() < 1e-12);
}

RC_GTEST_PROP(Rotation, KeepsLengthsAndAngles, ()) {
  const Pose a = motion();
  const Eigen::Vector3d p = vector(10), q = vector(10);
  RC_ASSERT(std::abs((a.rotation * p).dot(a.rotation * q) - p.dot(q)) < 1e-9);
}

}  // namespace
}  // namespace plumb
