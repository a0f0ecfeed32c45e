#pragma once
/// What to simulate: every option, declared once for the command line, the scene files and their
/// checks.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulate/option.hpp"
#include "simulate/scanner.hpp"

namespace plumb::simulate {

/// SI units throughout. What is not given follows from the rest: see `settled`.
struct Scene {
  std::string path = "city_loop";  ///< one of route_names(), or a TUM file of poses to scan from
  std::optional<std::int64_t> frames;
  std::optional<double> length;  ///< [m]
  std::optional<double> speed;   ///< [m/s]
  double rate = 10;              ///< [Hz]
  std::int64_t lines = 64;
  std::int64_t columns = 1024;
  double lowest = ScannerOptions().lowest;    ///< [rad]
  double highest = ScannerOptions().highest;  ///< [rad]
  double noise = 0.02;                        ///< [m]
  double range = 120;                         ///< [m]
  double height = 1.73;                       ///< of the sensor above the ground [m]
  double street_width = 14;                   ///< [m]
  double alike = 0;             ///< path after which streets look the same again [m]; 0: never
  std::optional<double> drift;  ///< [m]
  std::string drift_odometry, drift_truth;  ///< both or neither: drift to transplant
  std::int64_t seed = 1;
};

using Option = OptionOf<Scene>;

/// All options but `drift_from`, which takes two files.
const std::vector<Option>& options();

/// Sets the option from text. A quantity without its unit is in SI if `bare_is_si`, else refused.
/// Throws Error, which begins with `place`, for a value that is not a number, out of range or in a
/// unit of something else.
void set(Scene& scene, const Option& option, const std::string& text, bool bare_is_si,
         const std::string& place);

/// Whether the path is a file rather than one of route_names().
bool follows_file(const Scene& scene);

/// The drift [m] where none is asked, for a path of that length [m]: 10 m for 2.9 km.
double usual_drift(double length);

/// The scene with everything given: of frames, length and speed two say the third; alone, the speed
/// is 10 m/s; nothing given, the route's own length; `drift` is 10 m for 2.9 km unless given or
/// transplanted. Throws Error where options contradict each other.
Scene settled(Scene scene);

/// Reads a scene file, a YAML map of options; files named in it are relative to it. Throws Error
/// with file:line:column.
Scene read_scene(const std::filesystem::path& file);

/// The text that read_scene reads back as `scene`, with a first line that marks a folder as the
/// simulator's.
std::string scene_text(const Scene& scene);

/// The first line of scene_text.
extern const char* const scene_mark;

}  // namespace plumb::simulate
