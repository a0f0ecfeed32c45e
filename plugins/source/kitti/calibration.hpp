#pragma once
/// KITTI's calibration of laser and camera.

#include <filesystem>

#include "plumb/slam/trajectory.hpp"

namespace plumb::source_kitti {

/// T_camera_laser: the line `Tr:` (or `Tr_velo_to_cam:`) of a calib.txt, 12 numbers, a 3x4 matrix
/// [R | t] row by row. Throws Error with file and line: cannot be opened, no such line, no 12
/// numbers, no rotation.
Pose read_calibration(const std::filesystem::path& file);

/// The laser's poses from those of the camera: T_camera_laser^-1 T_world_camera T_camera_laser.
/// Where the world is the first camera's frame, as in KITTI, the new world is the first laser's: x
/// forward, z up.
void camera_to_laser(Trajectory& trajectory, const Pose& T_camera_laser);

}  // namespace plumb::source_kitti
