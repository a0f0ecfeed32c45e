#include "../finite.hpp"
#include "../fuzz.hpp"
#include "plumb/slam/io/trajectory_file.hpp"

using namespace plumb;

/// Poses, then their stamps.
PLUMB_FUZZ_READER(kitti_poses) {
  const auto parts = fuzz::parts_of(bytes, 2);
  const Trajectory read =
      read_kitti(fuzz::file_of(parts[0], "poses.txt"), fuzz::file_of(parts[1], "times.txt"));
  fuzz::require(is_finite(read.T_world_frame), "poses that were read are finite");
}
