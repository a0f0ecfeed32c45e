#pragma once
/// Drives that the simulator knows by itself.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plumb/slam/trajectory.hpp"

namespace plumb::simulate {

/// Their names:
/// `city_loop`     once round and a fifth of the way again
/// `figure_eight`  two loops that cross, and a fifth again
/// `out_and_back`  along a street, round at its end, back on the other lane
/// `blocks`        a grid of streets, most of them driven several times, both ways
const std::vector<std::string>& route_names();

struct RouteOptions {
  std::string name;
  std::size_t frames = 0;
  double length = 0;            ///< from the first frame to the last, on the map [m]
  double rate = 10;             ///< frames a second [1/s]; the speed is even and follows
  double sensor_height = 1.73;  ///< above the ground [m]
  std::uint64_t seed = 1;       ///< bends the streets and the hills
};

/// Poses of a car on the right lane of gentle hills: x ahead, y left, z up, with the road's slopes
/// and a slight rocking. Begins at stamp 0. Throws Error for a name that is none of route_names().
Trajectory drive(const RouteOptions& options);

}  // namespace plumb::simulate
