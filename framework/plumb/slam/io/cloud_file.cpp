/// Which reader takes a file. A further format is a reader of its own, declared in cloud_file.hpp,
/// a line here, its extension in frame_files.cpp (sequence_frames) and a fuzz driver in
/// tests/fuzz/readers.
#include "plumb/slam/io/cloud_file.hpp"

#include "plumb/data/io/file_text.hpp"

namespace plumb {

CloudFile read_cloud(const std::filesystem::path& file) {
  const auto extension = file.extension();
  if (extension == ".pcd" || extension == ".PCD") return read_pcd(file);
  if (extension == ".ply" || extension == ".PLY") return read_ply(file);
  io::refuse(
      file, "the name ends in " + io::in_quotes(extension.string()) + ": give a .pcd or .ply file");
}

}  // namespace plumb
