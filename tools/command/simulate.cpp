/// plumb simulate: a laser-SLAM sequence with exact truth.

#include "simulate/simulate.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "command/command.hpp"
#include "command_line.hpp"
#include "interrupt.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/slam/io/trajectory_text.hpp"
#include "simulate/indoor.hpp"
#include "simulate/names.hpp"
#include "simulate/route.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace {

struct Arguments {
  std::string scene;
  std::filesystem::path output;
  int threads = 0;
  std::map<std::string, std::string> options;  // as written, by key
  std::vector<std::string> drift_from;
};

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// All shipped scenes, of streets and of buildings.
std::vector<std::string> shipped() {
  std::vector<std::string> names = simulate::route_names();
  const auto& buildings = simulate::indoor_names();
  names.insert(names.end(), buildings.begin(), buildings.end());
  return names;
}

void refuse_no_scene(const Arguments& arguments) {
  if (!std::filesystem::is_regular_file(arguments.scene))
    throw Error("simulate: '" + arguments.scene +
                "' is neither a scene file nor a shipped scene; " +
                simulate::suggestion(arguments.scene, shipped()));
}

bool is_indoor(const Arguments& arguments) {
  if (is_one_of(simulate::indoor_names(), arguments.scene)) return true;
  if (is_one_of(simulate::route_names(), arguments.scene)) return false;
  if (const auto path = arguments.options.find("path"); path != arguments.options.end())
    return is_one_of(simulate::indoor_names(), path->second);
  if (arguments.scene.empty()) return false;
  refuse_no_scene(arguments);
  return simulate::is_indoor_scene(arguments.scene);
}

/// Throws UsageError for a given option that scenes of this kind do not have.
template <class S>
void refuse_others(const Arguments& arguments, const std::vector<simulate::OptionOf<S>>& options,
                   const std::string& kind) {
  std::string known;
  for (const auto& option : options) known += std::string(known.empty() ? "" : ", ") + option.key;
  for (const auto& [key, text] : arguments.options)
    if (std::none_of(options.begin(), options.end(), [&](const auto& o) { return key == o.key; }))
      throw UsageError("--" + key + ": " + kind + " has no such option; its options are " + known);
}

simulate::Scene scene_of(const Arguments& arguments) {
  refuse_others(arguments, simulate::options(), "a scene of streets");
  simulate::Scene scene;
  if (is_one_of(simulate::route_names(), arguments.scene)) {
    scene.path = arguments.scene;
  } else if (!arguments.scene.empty()) {
    refuse_no_scene(arguments);
    scene = simulate::read_scene(arguments.scene);
  }
  for (const simulate::Option& option : simulate::options())
    if (const auto given = arguments.options.find(option.key); given != arguments.options.end())
      usage([&] {
        simulate::set(scene, option, given->second, true, std::string("--") + option.key);
      });
  if (arguments.options.contains("path") && simulate::follows_file(scene))
    scene.path = std::filesystem::absolute(scene.path).string();
  if (!arguments.drift_from.empty()) {
    scene.drift_odometry = std::filesystem::absolute(arguments.drift_from[0]).string();
    scene.drift_truth = std::filesystem::absolute(arguments.drift_from[1]).string();
  }
  return scene;
}

simulate::IndoorScene indoor_scene_of(const Arguments& arguments) {
  refuse_others(arguments, simulate::indoor_options(), "a scene indoors");
  if (!arguments.drift_from.empty())
    throw UsageError(
        "--drift-from: a scene indoors has wheels of its own; say how far they err by "
        "--drift");
  simulate::IndoorScene scene;
  if (is_one_of(simulate::indoor_names(), arguments.scene))
    scene.path = arguments.scene;
  else if (std::filesystem::is_regular_file(arguments.scene))
    scene = simulate::read_indoor_scene(arguments.scene);
  for (const simulate::IndoorOption& option : simulate::indoor_options())
    if (const auto given = arguments.options.find(option.key); given != arguments.options.end())
      usage([&] {
        simulate::set_option(scene, option, given->second, true, std::string("--") + option.key);
      });
  return scene;
}

/// What was made, in a line, and what is not as it should be, in a sentence.
struct Made {
  std::string line, unsettled;
};

Made made_by(const Arguments& arguments,
             const std::function<void(std::size_t, std::size_t)>& progress) {
  remove_staging_when_interrupted();
  char rest[256];
  if (is_indoor(arguments)) {
    const simulate::IndoorSummary made = simulate::simulate(
        indoor_scene_of(arguments), arguments.output, arguments.threads, progress);
    std::snprintf(rest, sizeof rest, " (%zu lost), %.0f MB, %.1f m of path, drift %.2f m",
                  made.lost, 1e-6 * static_cast<double>(made.bytes), made.length, made.drift);
    return {counted(made.scans, "scans") + rest, made.unsettled};
  }
  const simulate::Summary made =
      simulate::simulate(scene_of(arguments), arguments.output, arguments.threads, progress);
  std::snprintf(rest, sizeof rest, ", %.1f million points, %.0f MB, %.1f m of path, drift %.2f m",
                1e-6 * static_cast<double>(made.points), 1e-6 * static_cast<double>(made.bytes),
                made.length, made.drift);
  return {counted(made.frames, "frames") + rest, made.unsettled};
}

void run(const Arguments& arguments) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto began = std::chrono::steady_clock::now();
  const auto progress = [&](std::size_t done, std::size_t of) {
    if (terminal && (done % 8 == 0 || done == of))
      std::fprintf(stderr, "\rscanned %zu of %zu frames%s", done, of, done == of ? "\n" : "");
  };
  const Made made = made_by(arguments, progress);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::cout << arguments.output.string() << ": " << made.line << " (" << io::fixed(seconds, 1)
            << " s)\n";
  if (made.unsettled.empty()) return;
  std::cerr << "plumb: " << made.unsettled << "\n";
  throw ExitWith{exit_unsettled};
}

/// An option of the command line, of streets, of buildings or of both.
void offer(Command& command, const std::shared_ptr<Arguments>& arguments,
           const simulate::OptionRange& option, const std::string& about,
           const std::string& group) {
  std::string flag = std::string("--") + option.key, dashed = flag;
  std::replace(dashed.begin() + 2, dashed.end(), '_', '-');
  if (dashed != flag) flag += "," + dashed;
  const std::string key = option.key;
  command
      .add_option_function(
          flag, [arguments, key](const std::string& text) { arguments->options[key] = text; },
          about)
      .type_name(option.quantity == Quantity::none
                     ? "VALUE"
                     : std::string("QUANTITY[") + si_symbol(option.quantity) + "]")
      .group(group);
}

void offer_all(Command& command, const std::shared_ptr<Arguments>& arguments) {
  const auto& indoors = simulate::indoor_options();
  const auto also = [&](const char* key) {
    return std::find_if(indoors.begin(), indoors.end(),
                        [&](const auto& option) { return std::string(key) == option.key; });
  };
  for (const simulate::Option& option : simulate::options()) {
    const auto twin = also(option.key);
    if (twin == indoors.end())
      offer(command, arguments, option, option.about, "Streets");
    else
      offer(command, arguments, option,
            std::string(option.about) == twin->about
                ? option.about
                : std::string(option.about) + "; indoors: " + twin->about,
            "Streets and buildings");
  }
  const auto& streets = simulate::options();
  for (const simulate::IndoorOption& option : indoors)
    if (std::none_of(streets.begin(), streets.end(),
                     [&](const auto& o) { return std::string(option.key) == o.key; }))
      offer(command, arguments, option, option.about, "Buildings");
}

}  // namespace

void add_simulate(Command& program) {
  Command command =
      program.add_subcommand("simulate", "Make a laser-SLAM sequence with exact truth");
  command.footer(
      "SCENE is city_loop, figure_eight, out_and_back, blocks (streets, seen by a 3-D scanner), "
      "corridor, lookalike, rooms (buildings, seen by a 2-D scanner), or a YAML file with the "
      "options below as keys, such as\n"
      "  path: blocks\n  length: 2.9 km\n  noise: 2 cm\n"
      "Options given here come after those of the file. Quantities take a unit (2.9km, 2cm); "
      "without one they are SI.\n"
      "OUTPUT becomes a sequence: frames/*.pcd, odometry.tum, truth.tum, and the scene that "
      "repeats it; of a building log.clf (CARMEN) and plan.txt (the walls, x1 y1 x2 y2) instead "
      "of frames.\n"
      "Frames hold no motion distortion; the same seed gives the same bytes, on any number of "
      "threads.\n\n"
      "Examples:\n"
      "  plumb simulate city_loop --frames 200 -o loop\n"
      "  plumb simulate blocks --frames 2700 --length 2.9km --drift 10 -o blocks\n"
      "  plumb simulate --path truth.tum --drift-from odometry.tum truth.tum -o drive\n"
      "  plumb simulate corridor --drop-in-turns 0.5 --kidnap 2 -o corridor");
  const auto arguments = std::make_shared<Arguments>();
  command
      .add_option("scene", arguments->scene,
                  "A shipped scene, or a scene file (city_loop if not given)")
      .type_name("SCENE");
  command
      .add_option("-o,--output", arguments->output,
                  "Folder to make; an earlier simulation in it is replaced")
      .required()
      .type_name("DIR");
  offer_all(command, arguments);
  command
      .add_option("--drift-from", arguments->drift_from,
                  "Lay the errors of this odometry onto the path, by distance")
      .expected(2)
      .type_name("ODOMETRY TRUTH");
  command.add_option("--threads", arguments->threads, "Threads; 0: one a core").range(0, 1024);
  command.callback([arguments] { run(*arguments); });
}

}  // namespace plumb::command
