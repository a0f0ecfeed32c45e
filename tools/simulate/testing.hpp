#pragma once
/// What the simulator's tests share.

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "plumb/data/io/file_testing.hpp"
#include "simulate/simulate.hpp"

namespace plumb::simulate {

using io::refusal;
using io::TestFolder;

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// All files below a folder, with what they hold.
inline std::map<std::string, std::string> files(const std::filesystem::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      found[std::filesystem::relative(entry.path(), folder).string()] = contents(entry.path());
  return found;
}

/// A quick scene: few rays, few frames.
inline Scene small_scene(const std::string& path, std::int64_t frames, double length) {
  Scene scene;
  scene.path = path;
  scene.frames = frames;
  scene.length = length;
  scene.lines = 16;
  scene.columns = 128;
  return scene;
}

}  // namespace plumb::simulate
