#include "simulate/indoor_scene.hpp"

#include <algorithm>

#include "simulate/scene_entries.hpp"

namespace plumb::simulate {
namespace {

bool is_indoor(const std::string& name) {
  return std::find(indoor_names().begin(), indoor_names().end(), name) != indoor_names().end();
}

double usual_length(const std::string& building) {
  return building == "corridor" ? 36 : building == "lookalike" ? 24 : 18;
}

}  // namespace

const std::vector<std::string>& indoor_names() {
  static const std::vector<std::string> names = {"corridor", "lookalike", "rooms"};
  return names;
}

const std::vector<IndoorOption>& indoor_options() {
  using I = IndoorScene;
  constexpr double pi = std::numbers::pi;
  static const std::vector<IndoorOption> all = {
      {"path", "building to drive through (corridor, lookalike, rooms)", Quantity::none, 0, 0,
       &I::path},
      {"length", "length of the long corridors or of the row of rooms; 36, 24 or 18 m by building",
       Quantity::length, 12, 500, &I::length},
      {"spacing", "distance of the corridors that look alike, by default 5 m", Quantity::length, 4,
       50, &I::spacing},
      {"overlap", "way driven again after the round, 8 m where there is room", Quantity::length, 0,
       500, &I::overlap},
      {"speed", "speed of the robot, by default 0.2 m/s", Quantity::speed, 0.01, 5, &I::speed},
      {"turn_rate", "turning on the spot, by default 0.1 rad/s", Quantity::angular_speed, 0.01, 5,
       &I::turn_rate},
      {"rate", "scans a second, by default 5 Hz", Quantity::frequency, 0.1, 100, &I::rate},
      {"field_of_view", "of a scan, by default 270 deg", Quantity::angle, 0.2, 2 * pi,
       &I::field_of_view},
      {"columns", "beams a scan, by default 541", Quantity::none, 8, 16384, &I::columns},
      {"range", "greatest range, read where nothing is hit, by default 10 m", Quantity::length, 1,
       100, &I::range},
      {"noise", "standard deviation of a range, by default 1 cm", Quantity::length, 0, 1,
       &I::noise},
      {"drift",
       "greatest position error of the wheel odometry; 3 % of the way if not given, in "
       "lookalike 40 % of the spacing",
       Quantity::length, 0, 1000, &I::drift},
      {"drop_in_turns", "share of the scans lost while turning, by default 0.3", Quantity::none, 0,
       1, &I::drop_in_turns},
      {"kidnap", "stretches of the way without a scan, by default 0", Quantity::none, 0, 100,
       &I::kidnap},
      {"kidnap_time", "length of each such stretch, by default 8 s", Quantity::time, 0.1, 600,
       &I::kidnap_time},
      {"seed", "picks the building, the noise and the drift: the same seed, the same bytes",
       Quantity::none, 0, 9007199254740992.0, &I::seed},
  };
  return all;
}

bool is_indoor_scene(const std::filesystem::path& file) {
  for (const SceneEntry& entry : scene_entries(file))
    if (entry.key == "path") return entry.value && is_indoor(*entry.value);
  return false;
}

IndoorScene read_indoor_scene(const std::filesystem::path& file) {
  IndoorScene scene;
  for (const SceneEntry& entry : scene_entries(file))
    set_option(scene, option_of(entry, indoor_options()), scalar_of(entry, entry.value), false,
               entry.value_place);
  return scene;
}

std::string scene_text(const IndoorScene& scene) {
  return text_of_scene(values_of(scene, indoor_options()));
}

IndoorScene settled(IndoorScene scene) {
  if (!is_indoor(scene.path))
    throw Error("scene: no building is called '" + scene.path + "'; " +
                suggestion(scene.path, indoor_names()));
  if (!scene.length) scene.length = usual_length(scene.path);
  if (!scene.overlap) scene.overlap = std::min(8.0, *scene.length - 10);
  if (*scene.overlap > *scene.length - 10)
    throw Error("scene: an overlap of " + written(*scene.overlap, Quantity::length) +
                " leaves the first corridor, which is " + written(*scene.length, Quantity::length) +
                " long; ask for at most 10 m less than its length");
  return scene;
}

}  // namespace plumb::simulate
