#pragma once
/// What the simulator's tests share.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "plumb/data/error.hpp"
#include "simulate/simulate.hpp"

namespace plumb::simulate {

/// A folder that goes when the test ends.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("plumb-simulate-" + name + "-" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
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

/// The sentence of the Error that `act` throws, "" if it throws none.
template <class Act>
std::string refusal(Act act) {
  try {
    act();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace plumb::simulate
