#pragma once
/// The sub-commands of `plumb`, one file each. A callback throws plumb::Error on a wrong input, and
/// UsageError (usage.hpp) on a wrong command line.

#include <filesystem>
#include <vector>

#include "plumb/plugin/registry.hpp"

namespace plumb::command {

/// What the program exits with, beside 0; `plumb --help` says what they mean.
inline constexpr int exit_refused = 1, exit_wrong_command_line = 2, exit_failed = 3,
                     exit_unsettled = 4, exit_worse = 5, exit_nothing = 6;

/// Thrown by a callback that has said all there is to say: the program exits with `code`.
struct ExitWith {
  int code;
};

class Command;  // command_line.hpp

void add_run(Command& program);
void add_check(Command& program);
void add_resolve(Command& program);
void add_graph(Command& program);
void add_migrate(Command& program);
void add_list(Command& program);
void add_inspect(Command& program);
void add_doctor(Command& program);
void add_schema(Command& program);
void add_simulate(Command& program);
void add_evaluate(Command& program);
void add_compare(Command& program);
void add_cache(Command& program);
void add_worker(Command& program);

/// `--plugin-path`, before or behind the sub-command; filled while the command line is read.
extern std::vector<std::filesystem::path> plugin_path;

/// The steps of this installation and of plugin_path.
Registry installed_steps();

}  // namespace plumb::command
