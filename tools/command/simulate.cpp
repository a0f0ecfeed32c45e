/// plumb simulate: a laser-SLAM sequence with exact truth.

#include "simulate/simulate.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "command/command.hpp"
#include "plumb/data/error.hpp"
#include "simulate/names.hpp"
#include "simulate/route.hpp"

namespace plumb::command {
namespace {

struct Arguments {
  std::string scene;
  std::filesystem::path output;
  int threads = 0;
  std::map<std::string, std::string> options;  // as written, by key
  std::vector<std::string> drift_from;
};

simulate::Scene scene_of(const Arguments& arguments) {
  simulate::Scene scene;
  const auto& routes = simulate::route_names();
  const bool is_route = std::find(routes.begin(), routes.end(), arguments.scene) != routes.end();
  if (is_route) {
    scene.path = arguments.scene;
  } else if (!arguments.scene.empty()) {
    if (!std::filesystem::is_regular_file(arguments.scene))
      throw Error("simulate: '" + arguments.scene +
                  "' is neither a scene file nor a shipped scene; " +
                  simulate::suggestion(arguments.scene, routes));
    scene = simulate::read_scene(arguments.scene);
  }
  for (const simulate::Option& option : simulate::options())
    if (const auto given = arguments.options.find(option.key); given != arguments.options.end())
      simulate::set(scene, option, given->second, true, std::string("--") + option.key);
  if (arguments.options.contains("path") && simulate::follows_file(scene))
    scene.path = std::filesystem::absolute(scene.path).string();
  if (!arguments.drift_from.empty()) {
    scene.drift_odometry = std::filesystem::absolute(arguments.drift_from[0]).string();
    scene.drift_truth = std::filesystem::absolute(arguments.drift_from[1]).string();
  }
  return scene;
}

void run(const Arguments& arguments) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto began = std::chrono::steady_clock::now();
  const auto progress = [&](std::size_t done, std::size_t of) {
    if (terminal && (done % 8 == 0 || done == of))
      std::fprintf(stderr, "\rscanned %zu of %zu frames%s", done, of, done == of ? "\n" : "");
  };
  const simulate::Summary made =
      simulate::simulate(scene_of(arguments), arguments.output, arguments.threads, progress);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::printf(
      "%s: %zu frames, %.1f million points, %.0f MB, %.1f m of path, drift %.2f m (%.1f s)\n",
      arguments.output.string().c_str(), made.frames, 1e-6 * static_cast<double>(made.points),
      1e-6 * static_cast<double>(made.bytes), made.length, made.drift, seconds);
}

}  // namespace

void add_simulate(CLI::App& app) {
  CLI::App* command = app.add_subcommand("simulate", "Make a laser-SLAM sequence with exact truth");
  command->footer(
      "SCENE is city_loop, figure_eight, out_and_back, blocks, or a YAML file with the options "
      "below as keys, such as\n"
      "  path: blocks\n  length: 2.9 km\n  noise: 2 cm\n"
      "Options given here come after those of the file. Quantities take a unit (2.9km, 2cm); "
      "without one they are SI.\n"
      "OUTPUT becomes a sequence: frames/*.pcd, odometry.tum, truth.tum, and the scene that "
      "repeats it.\n"
      "Frames hold no motion distortion; the same seed gives the same bytes, on any number of "
      "threads.\n\n"
      "Examples:\n"
      "  plumb simulate city_loop --frames 200 -o loop\n"
      "  plumb simulate blocks --frames 2700 --length 2.9km --drift 10 -o blocks\n"
      "  plumb simulate --path truth.tum --drift-from odometry.tum truth.tum -o drive");
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("scene", arguments->scene,
                   "A shipped scene, or a scene file (city_loop if not given)")
      ->type_name("SCENE");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder to make; an earlier simulation in it is replaced")
      ->required()
      ->type_name("DIR");
  for (const simulate::Option& option : simulate::options()) {
    std::string flag = std::string("--") + option.key;
    if (flag == "--street_width") flag += ",--street-width";
    const std::string key = option.key;
    command
        ->add_option_function<std::string>(
            flag, [arguments, key](const std::string& text) { arguments->options[key] = text; },
            option.about)
        ->type_name(option.quantity == Quantity::none
                        ? "VALUE"
                        : std::string("QUANTITY[") + si_symbol(option.quantity) + "]");
  }
  command
      ->add_option("--drift-from", arguments->drift_from,
                   "Lay the errors of this odometry onto the path, by distance")
      ->expected(2)
      ->type_name("ODOMETRY TRUTH");
  command->add_option("--threads", arguments->threads, "Threads; 0: one a core")
      ->check(CLI::Range(0, 1024));
  command->callback([arguments] { run(*arguments); });
}

}  // namespace plumb::command
