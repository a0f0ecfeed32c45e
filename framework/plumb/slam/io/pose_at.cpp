#include <algorithm>

#include "plumb/data/error.hpp"
#include "plumb/slam/io/trajectory_file.hpp"
#include "plumb/slam/io/trajectory_text.hpp"

namespace plumb {

Pose pose_at(const Trajectory& trajectory, double stamp, double slack) {
  const auto& stamps = trajectory.stamps;
  if (stamps.empty()) throw Error("the trajectory is empty: give one with at least one pose");
  if (!(stamp >= stamps.front() - slack && stamp <= stamps.back() + slack))
    throw Error("the stamp " + io::fixed(stamp, 6) +
                " lies outside the trajectory, which goes from " + io::fixed(stamps.front(), 6) +
                " to " + io::fixed(stamps.back(), 6) + ": give a trajectory that covers it");
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), stamp) - stamps.begin();
  if (after == 0) return trajectory.T_world_frame.front();
  if (after == std::ssize(stamps)) return trajectory.T_world_frame.back();
  const double before = stamps[after - 1];
  return interpolate(trajectory.T_world_frame[after - 1], trajectory.T_world_frame[after],
                     (stamp - before) / (stamps[after] - before));
}

}  // namespace plumb
