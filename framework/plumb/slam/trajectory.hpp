#pragma once
/// The poses of all frames of a run.

#include <vector>

#include "plumb/slam/eigen_archive.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb {

/// Stamp [s] and pose of every frame, in order of time. Both arrays are equally long.
struct Trajectory {
  std::vector<double> stamps;
  std::vector<Pose> T_world_frame;

  std::size_t size() const { return stamps.size(); }
};

/// Travelled distance [m] from the first frame to each frame.
std::vector<double> travelled(const Trajectory& trajectory);

/// Throws Error unless the trajectory is one of so many frames.
void require_pose_each(const Trajectory& trajectory, std::size_t frames);

template <class Archive, class T>
requires std::is_same_v<std::remove_const_t<T>, Trajectory>
void fields(Archive& a, T& t) { a(t.stamps, t.T_world_frame); }

}  // namespace plumb
