#pragma once
/// Keeps the points in a shell round the sensor.

#include "plumb/slam/cloud.hpp"

namespace plumb::filter_distance {

struct Shell {
  Cloud cloud;  ///< the points kept, in their order
  std::size_t nearer =
      0;  ///< points dropped because they are nearer than the least distance, or no number
  std::size_t farther = 0;
};

/// The points with least <= |p| <= most [m], compared as squares in float. Source: [Tang2024] 2.2.
Shell within_shell(const Cloud& cloud, float least, float most);

}  // namespace plumb::filter_distance
