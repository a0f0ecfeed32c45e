#include "simulate/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plumb/data/error.hpp"
#include "simulate/names.hpp"
#include "simulate/route.hpp"

namespace plumb::simulate {
namespace {

constexpr double usual_speed = 10;  // [m/s]

double usual_length(const std::string& route) { return route == "blocks" ? 2900 : 1000; }

}  // namespace

const std::vector<Option>& options() {
  constexpr double right_angle = 0.5 * std::numbers::pi;
  static const std::vector<Option> all = {
      {"path",
       "route to drive (city_loop, figure_eight, out_and_back, blocks) or a TUM file of poses to "
       "scan from",
       Quantity::none, 0, 0, &Scene::path},
      {"frames", "number of frames; of a TUM file the first so many", Quantity::none, 2, 1e7,
       &Scene::frames},
      {"length", "length of the drive", Quantity::length, 1, 1e6, &Scene::length},
      {"speed", "speed of the drive; 10 m/s if neither frames nor length say otherwise",
       Quantity::speed, 0.01, 100, &Scene::speed},
      {"rate", "turns of the scanner a second", Quantity::frequency, 0.1, 1000, &Scene::rate},
      {"lines", "lines of the scanner", Quantity::none, 1, 1024, &Scene::lines},
      {"columns", "directions a turn of each line", Quantity::none, 4, 16384, &Scene::columns},
      {"lowest", "elevation of the lowest line", Quantity::angle, -right_angle, right_angle,
       &Scene::lowest},
      {"highest", "elevation of the highest line", Quantity::angle, -right_angle, right_angle,
       &Scene::highest},
      {"noise", "standard deviation of a range", Quantity::length, 0, 1, &Scene::noise},
      {"range", "greatest range", Quantity::length, 1, 1000, &Scene::range},
      {"height", "height of the sensor above the ground", Quantity::length, 0.1, 10,
       &Scene::height},
      {"street_width", "distance between houses where one lane is driven", Quantity::length, 8, 100,
       &Scene::street_width},
      {"alike",
       "path after which the streets repeat themselves, blocks of equal houses; 0 m: never",
       Quantity::length, 0, 1e6, &Scene::alike},
      {"drift", "greatest position error of the odometry; 10 m for 2.9 km if not given",
       Quantity::length, 0, 1e4, &Scene::drift},
      {"seed", "picks the city, the noise and the drift: the same seed, the same bytes",
       Quantity::none, 0, 9007199254740992.0, &Scene::seed},
  };
  return all;
}

void set(Scene& scene, const Option& option, const std::string& text, bool bare_is_si,
         const std::string& place) {
  if (text.empty() && std::holds_alternative<std::string Scene::*>(option.field))
    throw Error(place + ": is empty; name one of: " + suggestion("", route_names()));
  set_option(scene, option, text, bare_is_si, place);
}

double usual_drift(double length) { return length * (10.0 / 2900.0); }

bool follows_file(const Scene& scene) {
  const auto& names = route_names();
  return std::find(names.begin(), names.end(), scene.path) == names.end();
}

Scene settled(Scene scene) {
  if (scene.highest < scene.lowest)
    throw Error("scene: the highest line lies below the lowest; exchange the two angles");
  if (scene.alike > 0 && scene.alike < 40)
    throw Error(
        "scene: 'alike' leaves no room for houses in blocks of less than 40 m; give more, or 0 m");
  const bool transplant = !scene.drift_odometry.empty();
  if (transplant && scene.drift)
    throw Error(
        "scene: 'drift' and 'drift_from' are both given, and the drift can be one only; leave one "
        "of them out");
  if (follows_file(scene)) {
    if (scene.length || scene.speed)
      throw Error("scene: the path '" + scene.path +
                  "' is a file, whose poses are taken as they are; leave 'length' and 'speed' out "
                  "('frames' takes the first "
                  "so many)");
    return scene;
  }
  if (scene.frames && scene.length && scene.speed)
    throw Error(
        "scene: of 'frames', 'length' and 'speed' two say the third; leave one of them out");
  if (!scene.length)
    scene.length = scene.frames ? scene.speed.value_or(usual_speed) / scene.rate *
                                      static_cast<double>(*scene.frames - 1)
                                : usual_length(scene.path);
  if (!scene.frames)
    scene.frames = std::max<std::int64_t>(
        2, std::llround(*scene.length * scene.rate / scene.speed.value_or(usual_speed)) + 1);
  scene.speed.reset();
  if (!transplant && !scene.drift) scene.drift = usual_drift(*scene.length);
  return scene;
}

}  // namespace plumb::simulate
