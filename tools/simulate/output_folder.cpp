#include "simulate/output_folder.hpp"

#include <algorithm>
#include <fstream>

#include "plumb/data/error.hpp"
#include "plumb/data/io/regular_file.hpp"
#include "simulate/scene.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;

constexpr const char* made[] = {"scene.yaml", "frames",  "odometry.tum",
                                "truth.tum",  "log.clf", "plan.txt"};

/// Whether the folder holds a simulation and nothing else.
bool is_simulation(const fs::path& folder) {
  if (!io::other_than_file(folder / "scene.yaml").empty()) return false;
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
    : staged_(place, "name another folder with -o") {
  if (fs::exists(staged_.place()) && !fs::is_empty(staged_.place()) && !is_simulation(staged_.place()))
    throw Error(place.string() + ": holds something that the simulator did not make; name another folder with -o");
  for (const std::string& name : folders) fs::create_directory(staged_.staging() / name);
}

void OutputFolder::write(const fs::path& relative, const std::string& bytes) const {
  const fs::path to = staged_.staging() / relative;
  std::ofstream file(to, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw Error(to.string() + ": cannot be written; is the disk full?");
}

}  // namespace plumb::simulate
