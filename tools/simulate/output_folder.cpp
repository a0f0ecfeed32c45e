#include "simulate/output_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "plumb/data/error.hpp"
#include "simulate/scene.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;

constexpr const char* made[] = {"scene.yaml", "frames",  "odometry.tum",
                                "truth.tum",  "log.clf", "plan.txt"};

/// Whether the folder holds a simulation and nothing else.
bool is_simulation(const fs::path& folder) {
  std::ifstream scene(folder / "scene.yaml");
  std::string line;
  if (!std::getline(scene, line) || !line.starts_with(scene_mark)) return false;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (std::find(std::begin(made), std::end(made), name) == std::end(made)) return false;
  }
  if (fs::is_directory(folder / "frames"))
    for (const auto& entry : fs::directory_iterator(folder / "frames"))
      if (entry.path().extension() != ".pcd") return false;
  return true;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& place, const std::vector<std::string>& folders)
    : place_(fs::absolute(place).lexically_normal()) {
  if (!place_.has_filename()) place_ = place_.parent_path();
  try {
    if (fs::exists(place_)) {
      if (!fs::is_directory(place_))
        throw Error(place.string() + ": is a file; name a folder for the sequence");
      if (!fs::is_empty(place_) && !is_simulation(place_))
        throw Error(place.string() +
                    ": holds something that the simulator did not make; name another folder");
    }
    const fs::path beside = place_.string() + ".partial-" + std::to_string(::getpid());
    fs::create_directories(beside);
    beside_ = beside;
    for (const std::string& name : folders) fs::create_directory(beside / name);
  } catch (const fs::filesystem_error& e) {
    throw Error(place.string() + ": cannot be made (" + e.code().message() +
                "); name a folder that can be written");
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!beside_.empty()) fs::remove_all(beside_, ignored);
}

void OutputFolder::write(const fs::path& relative, const std::string& bytes) const {
  std::ofstream file(beside_ / relative, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw Error((beside_ / relative).string() + ": cannot be written; is the disk full?");
}

void OutputFolder::finish() {
  const fs::path earlier = beside_.string() + ".earlier";
  try {
    const bool replace = fs::exists(place_);
    if (replace) fs::rename(place_, earlier);
    fs::rename(beside_, place_);
    beside_.clear();
    if (replace) fs::remove_all(earlier);
  } catch (const fs::filesystem_error& e) {
    throw Error(place_.string() + ": cannot be replaced (" + e.code().message() +
                "); name another folder");
  }
}

}  // namespace plumb::simulate
