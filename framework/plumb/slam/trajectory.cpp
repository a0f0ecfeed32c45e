#include "plumb/slam/trajectory.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb {

std::vector<double> travelled(const Trajectory& trajectory) {
  std::vector<double> path(trajectory.size(), 0.0);
  for (std::size_t k = 1; k < path.size(); ++k)
    path[k] = path[k - 1] + (trajectory.T_world_frame[k].translation -
                             trajectory.T_world_frame[k - 1].translation)
                                .norm();
  return path;
}

void require_pose_each(const Trajectory& trajectory, std::size_t frames) {
  if (frames != trajectory.size())
    throw Error("got " + counted(frames, "frames") + " but " + counted(trajectory.size(), "poses") +
                " in the trajectory; wire the trajectory of these frames");
}

}  // namespace plumb
