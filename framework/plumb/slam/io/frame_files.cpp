#include "plumb/slam/io/frame_files.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <unordered_set>
#include <utility>

#include "plumb/data/counted.hpp"
#include "plumb/data/io/fence.hpp"
#include "plumb/data/io/file_identity.hpp"
#include "plumb/data/io/file_text.hpp"
#include "plumb/data/io/regular_file.hpp"

namespace plumb::io {

namespace fs = std::filesystem;

std::vector<FrameFile> files_in(const fs::path& folder, const std::vector<std::string>& extensions,
                                const std::string& prefix) {
  require_inside_of_fence(folder);
  std::error_code error;
  std::vector<FrameFile> files;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const std::string extension = at->path().extension().string();
    if (name.front() == '.' || std::ranges::find(extensions, extension) == extensions.end())
      continue;
    files.push_back({at->path(), prefix + name});
  }
  if (error)
    refuse(folder, "cannot be read (" + error.message() + "): check the path and the rights");
  std::ranges::sort(files, {}, &FrameFile::name);
  return files;
}

namespace {

void require_frame(const fs::path& list, std::size_t line, const fs::path& path,
                   const std::string& name) {
  require_inside_of_fence(path);
  std::error_code error;
  if (fs::is_regular_file(path, error)) return;
  const std::string other = other_than_file(path);
  const std::string why = other.empty()
                              ? " is missing: paths are relative to the folder that holds the list"
                              : " is " + other + ", not a regular file: list files";
  refuse(list, line, "frame " + in_quotes(name) + why);
}

std::vector<FrameFile> listed_in(const fs::path& list, const fs::path& folder) {
  const FileBytes bytes(list);
  Lines lines(bytes.view());
  std::vector<FrameFile> files;
  std::unordered_set<std::string> seen;  // a way out and back lists its frames twice
  for (std::string_view line; lines.next(line);) {
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::string name(line);
    const fs::path path = folder / name;
    if (seen.insert(name).second) require_frame(list, lines.number(), path, name);
    files.push_back({path, name});
  }
  if (files.empty()) refuse(list, "lists no frame: write one path a line");
  return files;
}

}  // namespace

std::vector<FrameFile> sequence_frames(const fs::path& folder) {
  require_folder(folder, "give a folder with frames/*.pcd or frames.txt, and odometry.tum");
  std::error_code error;
  const fs::path list = folder / "frames.txt", frames = folder / "frames";
  if (fs::exists(list, error)) return listed_in(list, folder);
  auto files = fs::is_directory(frames, error) ? files_in(frames, {".pcd", ".ply"}, "frames/")
                                               : std::vector<FrameFile>();
  if (files.empty())
    refuse(folder,
           "has no frames: expected frames/*.pcd or *.ply, or a list of them in frames.txt");
  return files;
}

Hash128 key_of(const FrameFile& file) {
  struct stat status;
  if (::stat(file.path.c_str(), &status) != 0)
    refuse(file.path, std::string("the frame cannot be opened (") + std::strerror(errno) +
                          "): restore the file or take it off the list");
  if (!S_ISREG(status.st_mode))
    refuse(file.path, "is not a regular file, so it is not a frame: remove it");
  Hasher hasher;
  hasher.text(file.name);
  if (!add_identity(hasher, file.path))
    refuse(file.path, "the frame cannot be read: restore the file or take it off the list");
  return hasher.hash();
}

Frame frame_of(std::size_t k, CloudFile read, Context& context) {
  if (read.dropped) context.count("points with a non-finite coordinate dropped", read.dropped);
  return {static_cast<std::uint32_t>(k), std::move(read.cloud)};
}

void require_folder(const fs::path& path, const std::string& cure) {
  std::error_code error;
  if (fs::is_directory(path, error)) return;
  refuse(path, fs::exists(path, error) ? "is not a directory: " + cure
                                       : "there is no such folder: " + cure);
}

void require_pose_each(const fs::path& folder, std::size_t frames, const fs::path& poses_from,
                       std::size_t poses) {
  if (frames == 1)
    refuse(folder, "has 1 frame, but needs at least 2: there is nothing to straighten");
  if (poses == frames) return;
  refuse(folder, "has " + counted(frames, "frames") + ", but " + poses_from.string() + " has " +
                     counted(poses, "poses") +
                     ": give exactly one pose a frame, in the same order");
}

}  // namespace plumb::io
