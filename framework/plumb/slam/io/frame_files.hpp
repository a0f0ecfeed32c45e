#pragma once
/// The files that hold a sequence's frames: found, put in order, and known by a key without being
/// read.

#include <filesystem>
#include <string>
#include <vector>

#include "plumb/data/hash.hpp"
#include "plumb/plugin/context.hpp"
#include "plumb/slam/io/cloud_file.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::io {

/// A frame's file, and its name relative to the sequence's folder.
struct FrameFile {
  std::filesystem::path path;
  std::string name;
};

/// The files of `folder` that end in one of `extensions` (as ".pcd"), ordered by name, byte by
/// byte; hidden ones are left out. Their names begin with `prefix`. Throws Error when there is no
/// such folder or it cannot be read.
std::vector<FrameFile> files_in(const std::filesystem::path& folder,
                                const std::vector<std::string>& extensions,
                                const std::string& prefix = "");

/// The frames of a sequence's folder in order: those that frames.txt lists (one path a line,
/// relative to the folder; blank lines and lines that begin with # are skipped), or, without that
/// file, frames/*.pcd and *.ply by name. Throws Error: no such folder, no frame in it, a listed
/// frame that is missing (with the line).
std::vector<FrameFile> sequence_frames(const std::filesystem::path& folder);

/// A key that changes when the file does: hash of its name, size and time of change [ns]. Throws
/// Error when it is no file.
Hash128 key_of(const FrameFile& file);

/// Frame k, with the cloud that was read of its file; the points that were left out are counted.
Frame frame_of(std::size_t k, CloudFile read, Context& context);

/// Throws Error unless `path` is a folder.
void require_folder(const std::filesystem::path& path, const std::string& cure);

/// Throws Error unless the folder has at least two frames and exactly one pose a frame;
/// `poses_from` says where they were read.
void require_pose_each(const std::filesystem::path& folder, std::size_t frames,
                       const std::filesystem::path& poses_from, std::size_t poses);

}  // namespace plumb::io
