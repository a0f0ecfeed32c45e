/// plumb doctor: what was found where, what was refused and why, what the build left out. Each
/// module is loaded in a process of its own.

#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <iostream>
#include <map>
#include <set>

#include "command.hpp"
#include "command_line.hpp"
#include "plumb/data/counted.hpp"
#include "plumb/pipeline/yaml/diagnostics.hpp"

namespace plumb::command {
namespace {

/// Loads a module in a child process. Returns "" or what happened.
std::string trial(const std::string& file) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return "no pipe can be made";
  const pid_t child = fork();  // this command has started no thread
  if (child == 0) {
    std::string said;
    try {
      load_module(file);
    } catch (const std::exception& e) {
      said = e.what();
    }
    if (write(pipe_ends[1], said.data(), said.size()) < 0) _exit(1);
    _exit(0);
  }
  close(pipe_ends[1]);
  std::string said;
  char buffer[512];
  for (ssize_t n; (n = read(pipe_ends[0], buffer, sizeof buffer)) > 0;)
    said.append(buffer, static_cast<std::size_t>(n));
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status))
    return std::string("crashes when it is loaded: ") + strsignal(WTERMSIG(status));
  return said;
}

/// A line for each reason.
void print_left_out(const StepsLeftOut& steps) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const auto& [step, why] : steps) by_reason[why].push_back(step);
  for (const auto& [why, names] : by_reason)
    std::cout << "left out of this build: " << pipeline::joined(names) << ": " << why << "\n";
}

}  // namespace

void add_doctor(Command& program) {
  Command command = program.add_subcommand(
      "doctor",
      "Says what modules were found where, what was refused and why, and what the build left out");
  command.footer("Exit 1 when anything was refused.");
  command.callback([] {
    const Registry steps = installed_steps();
    std::cout << "plumb " << PLUMB_VERSION << "\nABI: " << abi_tag()
              << "\n\nSearched, in this order:\n";
    for (const auto& folder : steps.folders()) std::cout << "  " << folder.string() << "\n";
    std::set<std::string> modules;
    for (const StepDescription* step : steps.all()) modules.insert(step->module);
    std::vector<Refusal> refused = steps.refused();
    std::size_t good = 0;
    for (const std::string& module : modules) {
      const std::string fault = trial(module);
      if (fault.empty())
        ++good;
      else
        refused.push_back({module, fault});
    }
    std::cout << "\n"
              << counted(steps.all().size(), "steps") << " in "
              << counted(modules.size(), "modules") << "; " << good << " load\n";
    for (const Refusal& refusal : refused)
      std::cout << "refused: " << refusal.file.string() << "\n  " << refusal.why << "\n";
    print_left_out(steps.left_out());
    if (!refused.empty()) throw ExitWith{1};
  });
}

}  // namespace plumb::command
