#pragma once
/// What to simulate indoors: a building, a planar scanner and the wheels that carry it.

#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "simulate/option.hpp"

namespace plumb::simulate {

/// SI units throughout. What is not given follows from the rest: see `settled`.
struct IndoorScene {
  std::string path = "corridor";  ///< one of indoor_names()
  std::optional<double> length;   ///< of the building's long corridors, of its row of rooms [m]
  double spacing = 5;             ///< between corridors that look alike [m]
  std::optional<double> overlap;  ///< driven again after the round [m]
  double speed = 0.2;             ///< [m/s]
  double turn_rate = 0.1;         ///< on the spot [rad/s]
  double rate = 5;                ///< scans a second [Hz]
  double field_of_view = 1.5 * std::numbers::pi;  ///< [rad]
  std::int64_t columns = 541;                     ///< beams a scan
  double range = 10;                              ///< [m]
  double noise = 0.01;                            ///< [m]
  std::optional<double> drift;                    ///< of the wheel odometry [m]
  double drop_in_turns = 0.3;                     ///< share of the scans
  std::int64_t kidnap = 0;                        ///< stretches without a scan
  double kidnap_time = 8;                         ///< of each [s]
  std::int64_t seed = 1;
};

using IndoorOption = OptionOf<IndoorScene>;

/// The buildings:
/// `corridor`   a ring of corridors: two long ones that look alike and hold little but doors and
///              pillars, two short ones with open rooms
/// `lookalike`  four parallel corridors, each the copy of the one before turned half round, joined
///              at both ends by passages
/// `rooms`      two rows of furnished rooms, driven through from door to door
const std::vector<std::string>& indoor_names();

const std::vector<IndoorOption>& indoor_options();

/// Whether the file is a scene whose path is one of indoor_names(). Throws Error as read_scene.
bool is_indoor_scene(const std::filesystem::path& file);

/// Reads a scene file, a YAML map of options. Throws Error with file:line:column.
IndoorScene read_indoor_scene(const std::filesystem::path& file);

/// The text that read_indoor_scene reads back as `scene`.
std::string scene_text(const IndoorScene& scene);

/// The scene with `length` and `overlap` given. Throws Error where the building leaves no room for
/// what is asked.
IndoorScene settled(IndoorScene scene);

}  // namespace plumb::simulate
