#pragma once
/// For tests of readers and writers: files in a folder that goes with the test, and the sentence
/// that an action ends in.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "plumb/slam/cloud.hpp"
#include "plumb/data/error.hpp"

namespace plumb::io {

/// A folder of its own, removed with all files in it at the end of its scope.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "plumb_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw Error("no folder for the test could be made");
    path_ = name;
  }
  TestFolder(const TestFolder&) = delete;
  ~TestFolder() { std::filesystem::remove_all(path_); }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::filesystem::remove(path_ / name);  // to truncate a file may wait for the disk
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// Changes one byte of a file.
inline void flip_byte(const std::filesystem::path& file, std::size_t at, char bits = 0x10) {
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekg(static_cast<std::streamoff>(at));
  const char changed = static_cast<char>(bytes.get() ^ bits);
  bytes.seekp(static_cast<std::streamoff>(at));
  bytes.put(changed);
}

/// What the Error says that `action` throws; a word about it if it throws none.
template <class Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "(nothing was refused)";
}

/// `count` points with all arrays, no two alike.
inline Cloud full_cloud(std::size_t count) {
  Cloud cloud;
  for (std::size_t k = 0; k < count; ++k) {
    const float f = static_cast<float>(k);
    cloud.add({0.1f + f, -2.5f * f, 1e-3f * f * f});
    cloud.intensity.push_back(100 + f / 3);
    cloud.time.push_back(1e-4f * f);
    cloud.ring.push_back(static_cast<std::uint16_t>(40000 + k));
    cloud.nx.push_back(std::cos(f));
    cloud.ny.push_back(std::sin(f));
    cloud.nz.push_back(0);
  }
  return cloud;
}

}  // namespace plumb::io
