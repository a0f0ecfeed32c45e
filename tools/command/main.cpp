/// The `plumb` command.

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "command.hpp"
#include "command_line.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/io/plain_text.hpp"
#include "plumb/data/io/staged_folder.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "usage.hpp"

namespace plumb::command {

std::vector<std::filesystem::path> plugin_path;

Registry installed_steps() { return Registry::scan(Registry::standard_folders(plugin_path)); }

namespace {

/// All that the command says goes through here: names, paths and values of others must not steer
/// the terminal.
class PlainStream {
 public:
  explicit PlainStream(std::ostream& stream) : stream_(stream), to_(stream.rdbuf()), plain_(*to_) {
    stream_.rdbuf(&plain_);
  }
  PlainStream(const PlainStream&) = delete;
  ~PlainStream() { stream_.rdbuf(to_); }

 private:
  std::ostream& stream_;
  std::streambuf* to_;
  io::PlainBuffer plain_;
};

}  // namespace

}  // namespace plumb::command

namespace {

/// Takes the numbers of standard input, output and error if they are closed, so that no file of a
/// run gets one of them and what is said there.
void open_standard_files() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(number, F_GETFD) < 0 &&
        open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0)
      _exit(plumb::command::exit_refused);
}

/// As many open files as the system lets it have: compare holds a few for each of its runs.
void allow_open_files() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// When all is done: whether it could also be said.
int said() {
  errno = 0;
  if (std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout)) return 0;
  std::cerr << "plumb: standard output does not take what was to be said"
            << (errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "")
            << "; all else is done\n";
  return plumb::command::exit_unsettled;
}

/// All that stands before and behind the sub-commands.
void set_up(plumb::command::Program& program) {
  plumb::command::Command command = program.command();
  command.footer(
      "Start with:\n"
      "  plumb simulate city_loop -o street               a sequence with drift and exact truth\n"
      "  plumb run pipelines/plumb.yaml --set input=street -o out\n"
      "  plumb list; plumb inspect describe.fpfh         what a pipeline can be made of\n\n"
      "Exit: 0 done; 1 refused before anything ran, or a fault found by doctor or cache verify;\n"
      "2 the command line is wrong: an option, its value, or two that do not go together;\n"
      "3 a step refused its input or failed while running, or the results could not be written;\n"
      "4 done and the results in place, but standard output or the disk reported an error at the "
      "end, which is printed;\n"
      "5, 6 (compare only) a variant is worse; nothing could be measured or compared.");
  command.require_subcommand(1, 1);
  command.fallthrough();  // what stands below serves behind the sub-command as well
  command
      .add_option("--plugin-path", plumb::command::plugin_path,
                  "A further folder with modules (also PLUMB_PLUGIN_PATH), before or behind the "
                  "command; may be given again")
      .one_value_each();
  program.add_version(PLUMB_VERSION);
}

void add_commands(plumb::command::Command command) {
  plumb::command::add_run(command);
  plumb::command::add_check(command);
  plumb::command::add_resolve(command);
  plumb::command::add_graph(command);
  plumb::command::add_migrate(command);
  plumb::command::add_list(command);
  plumb::command::add_inspect(command);
  plumb::command::add_doctor(command);
  plumb::command::add_schema(command);
  plumb::command::add_simulate(command);
  plumb::command::add_evaluate(command);
  plumb::command::add_compare(command);
  plumb::command::add_cache(command);
  plumb::command::add_worker(command);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_files();
  allow_open_files();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    std::cerr << "plumb: this build needs a processor with AVX2 and FMA; configure with "
                 "-DPLUMB_ARCH= for any x86-64\n";
    return plumb::command::exit_refused;
  }
  const plumb::command::PlainStream out(std::cout), err(std::cerr);
  plumb::command::Program program(
      "plumb", "Plumb straightens drifted laser-SLAM point clouds, as a pipeline in YAML says.");
  set_up(program);
  add_commands(program.command());
  try {
    return program.parse(argc, argv) ? said() : plumb::command::exit_wrong_command_line;
  } catch (const plumb::command::ExitWith& e) {
    return e.code;
  } catch (const plumb::command::UsageError& e) {
    std::cerr << "plumb: " << e.what() << '\n';
    return plumb::command::exit_wrong_command_line;
  } catch (const plumb::PipelineError& e) {
    std::cerr << e.what() << '\n';
    return plumb::command::exit_refused;
  } catch (const plumb::io::WriteError& e) {
    std::cerr << "plumb: " << e.what() << '\n';
    return plumb::command::exit_failed;
  } catch (const std::exception& e) {
    std::cerr << "plumb: " << e.what() << '\n';
    return plumb::command::exit_refused;
  }
}
