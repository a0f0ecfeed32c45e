#pragma once
/// For tests of readers and writers: files in a folder that goes with the test, and the sentence
/// that an action ends in.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

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

}  // namespace plumb::io
