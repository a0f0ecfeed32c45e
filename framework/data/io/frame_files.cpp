#include "plumb/data/io/frame_files.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "plumb/data/io/file_text.hpp"

namespace plumb::io {

namespace fs = std::filesystem;

std::vector<FrameFile> files_in(const fs::path& folder, const std::vector<std::string>& extensions,
                                const std::string& prefix) {
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

Hash128 key_of(const FrameFile& file) {
  struct stat status;
  if (::stat(file.path.c_str(), &status) != 0)
    refuse(file.path, std::string("the frame cannot be opened (") + std::strerror(errno) +
                          "): restore the file or take it off the list");
  if (!S_ISREG(status.st_mode))
    refuse(file.path, "is not a regular file, so it is no frame: remove it");
  const std::int64_t facts[] = {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
  Hasher hasher;
  hasher.text(file.name);
  hasher.bytes(facts, sizeof facts);
  return hasher.hash();
}

void require_folder(const fs::path& path, const std::string& cure) {
  std::error_code error;
  if (fs::is_directory(path, error)) return;
  refuse(path,
         fs::exists(path, error) ? "is not a folder: " + cure : "there is no such folder: " + cure);
}

void require_pose_each(const fs::path& folder, std::size_t frames, const fs::path& poses_from,
                       std::size_t poses) {
  if (frames == 1)
    refuse(folder, "has 1 frame, but needs at least 2: there is nothing to straighten");
  if (poses == frames) return;
  refuse(folder, "has " + std::to_string(frames) + " frames, but " + poses_from.string() + " has " +
                     std::to_string(poses) +
                     " poses: give exactly one pose a frame, in the same order");
}

}  // namespace plumb::io
