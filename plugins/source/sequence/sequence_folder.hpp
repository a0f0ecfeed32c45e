#pragma once
/// A sequence as a folder: its list of frames, and one frame as a cloud in sensor coordinates.

#include <filesystem>
#include <vector>

#include "plumb/data/io/cloud_file.hpp"
#include "plumb/data/io/frame_files.hpp"
#include "plumb/geometry/pose.hpp"

namespace plumb {

/// The frames of `folder` in order: those that frames.txt lists (one path a line, relative to the
/// folder; blank lines and lines that begin with # are skipped), or, without that file,
/// frames/*.pcd and *.ply by name. Throws Error: no such folder, no frame in it, a listed frame
/// that is missing (with the line).
std::vector<io::FrameFile> frames_of(const std::filesystem::path& folder);

/// The cloud, given in world coordinates, in those of the frame: points by T_world_frame's inverse,
/// reckoned in double; normals turned.
void bring_to_frame(Cloud& cloud, const Pose& T_world_frame);

}  // namespace plumb
