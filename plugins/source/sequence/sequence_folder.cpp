#include "sequence_folder.hpp"

#include "plumb/data/io/file_text.hpp"

namespace plumb {

namespace fs = std::filesystem;

namespace {

std::vector<io::FrameFile> listed_in(const fs::path& list, const fs::path& folder) {
  const io::FileBytes bytes(list);
  io::Lines lines(bytes.view());
  std::vector<io::FrameFile> files;
  for (std::string_view line; lines.next(line);) {
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    if (line.empty() || line.front() == '#') continue;
    const std::string name(line);
    std::error_code error;
    if (!fs::is_regular_file(folder / name, error))
      io::refuse(list, lines.number(),
                 "frame " + io::in_quotes(name) +
                     " is missing: paths are relative to the folder that holds the list");
    files.push_back({folder / name, name});
  }
  if (files.empty()) io::refuse(list, "lists no frame: write one path a line");
  return files;
}

}  // namespace

std::vector<io::FrameFile> frames_of(const fs::path& folder) {
  io::require_folder(folder, "give a folder with frames/*.pcd or frames.txt, and odometry.tum");
  std::error_code error;
  const fs::path list = folder / "frames.txt", frames = folder / "frames";
  if (fs::exists(list, error)) return listed_in(list, folder);
  auto files = fs::is_directory(frames, error) ? io::files_in(frames, {".pcd", ".ply"}, "frames/")
                                               : std::vector<io::FrameFile>();
  if (files.empty())
    io::refuse(folder,
               "has no frames: expected frames/*.pcd or *.ply, or a list of them in frames.txt");
  return files;
}

void bring_to_frame(Cloud& cloud, const Pose& T_world_frame) {
  const Pose T_frame_world = T_world_frame.inverse();
  const Eigen::Matrix3d r = T_frame_world.matrix();
  const Eigen::Vector3d& t = T_frame_world.translation;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f p = (r * cloud.point(k).cast<double>() + t).cast<float>();
    cloud.x[k] = p.x();
    cloud.y[k] = p.y();
    cloud.z[k] = p.z();
  }
  if (!cloud.has_normals()) return;
  for (std::size_t k = 0; k < cloud.size(); ++k) {
    const Eigen::Vector3f n = (r * cloud.normal(k).cast<double>()).cast<float>();
    cloud.nx[k] = n.x();
    cloud.ny[k] = n.y();
    cloud.nz[k] = n.z();
  }
}

}  // namespace plumb
