/// Scenes as YAML: a flat map of options.

#include "plumb/data/error.hpp"
#include "simulate/names.hpp"
#include "simulate/route.hpp"
#include "simulate/scene.hpp"
#include "simulate/scene_entries.hpp"

namespace plumb::simulate {
namespace {

namespace fs = std::filesystem;

/// A file named in a scene, found from the scene's own folder.
std::string beside(const fs::path& scene, const std::string& named) {
  return (fs::absolute(scene).parent_path() / named).lexically_normal().string();
}

void set_drift_from(Scene& scene, const fs::path& file, const SceneEntry& entry) {
  if (entry.list.size() != 2)
    throw Error(entry.value_place +
                ": 'drift_from' takes two files; write [odometry.tum, truth.tum]");
  scene.drift_odometry = beside(file, scalar_of(entry, entry.list[0]));
  scene.drift_truth = beside(file, scalar_of(entry, entry.list[1]));
}

}  // namespace

const char* const scene_mark = "# A scene of plumb simulate";

Scene read_scene(const fs::path& file) {
  Scene scene;
  for (const SceneEntry& entry : scene_entries(file)) {
    if (entry.key == "drift_from")
      set_drift_from(scene, file, entry);
    else
      set(scene, option_of(entry, options(), {"drift_from"}), scalar_of(entry, entry.value), false,
          entry.value_place);
  }
  if (follows_file(scene)) {
    if (!scene.path.ends_with(".tum"))
      throw Error(file.string() + ": path '" + scene.path +
                  "' is neither a route nor a .tum file; " + suggestion(scene.path, route_names()));
    scene.path = beside(file, scene.path);
  }
  return scene;
}

std::string scene_text(const Scene& scene) {
  std::vector<std::string> drift_from;
  if (!scene.drift_odometry.empty()) drift_from = {scene.drift_odometry, scene.drift_truth};
  return text_of_scene(values_of(scene, options()), drift_from);
}

}  // namespace plumb::simulate
