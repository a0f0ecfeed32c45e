#pragma once
/// A map as a file, and what its coordinates count from.

#include <string>

#include "plumb/slam/trajectory.hpp"

namespace plumb::write_map {

enum class MapFormat { ply, pcd };

/// Zero while all poses are within 10 km of the world's origin: single precision then keeps half a
/// millimetre. Else the first pose's place, rounded to whole kilometres [m].
Eigen::Vector3d map_origin(const Trajectory& trajectory);

/// The file's beginning; 12 bytes a point follow: x, y and z as float32. An origin other than zero
/// is told in a comment: "origin X Y Z: add to coordinates for world coordinates [m]".
std::string map_header(std::size_t points, const Eigen::Vector3d& origin, MapFormat format);

}  // namespace plumb::write_map
