#pragma once
/// The sub-commands of `plumb`, one file each. A callback throws plumb::Error on a wrong input, and
/// UsageError (usage.hpp) on a wrong command line.

#include <filesystem>
#include <vector>

#include "plumb/plugin/registry.hpp"

namespace CLI {
class App;
}

namespace plumb::command {

/// What the program exits with, beside 0; `plumb --help` says what they mean.
inline constexpr int exit_refused = 1, exit_wrong_command_line = 2, exit_failed = 3,
                     exit_unsettled = 4, exit_worse = 5, exit_nothing = 6;

void add_run(CLI::App& app);
void add_check(CLI::App& app);
void add_resolve(CLI::App& app);
void add_graph(CLI::App& app);
void add_migrate(CLI::App& app);
void add_list(CLI::App& app);
void add_inspect(CLI::App& app);
void add_doctor(CLI::App& app);
void add_schema(CLI::App& app);
void add_simulate(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_compare(CLI::App& app);
void add_cache(CLI::App& app);
void add_worker(CLI::App& app);

/// `--plugin-path`, before or behind the sub-command; filled while the command line is read.
extern std::vector<std::filesystem::path> plugin_path;

/// The steps of this installation and of plugin_path.
Registry installed_steps();

}  // namespace plumb::command
