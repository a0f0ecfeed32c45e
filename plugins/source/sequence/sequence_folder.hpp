#pragma once
/// A frame that was stored in world coordinates, as the sensor saw it.

#include "plumb/slam/cloud.hpp"
#include "plumb/slam/geometry/pose.hpp"

namespace plumb::source_sequence {

/// The cloud, given in world coordinates, in those of the frame: points by T_world_frame's inverse,
/// reckoned in double; normals turned.
void bring_to_frame(Cloud& cloud, const Pose& T_world_frame);

}  // namespace plumb::source_sequence
