#include "plumb/slam/trajectory.hpp"

namespace plumb {

std::vector<double> travelled(const Trajectory& trajectory) {
  std::vector<double> path(trajectory.size(), 0.0);
  for (std::size_t k = 1; k < path.size(); ++k)
    path[k] = path[k - 1] + (trajectory.T_world_frame[k].translation -
                             trajectory.T_world_frame[k - 1].translation)
                                .norm();
  return path;
}

}  // namespace plumb
