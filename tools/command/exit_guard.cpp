#include "exit_guard.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "command.hpp"
#include "plumb/data/io/staged_folder.hpp"
#include "plumb/engine/run/running_call.hpp"

namespace plumb::command {
namespace {

std::atomic<int> guards = 0;
std::atomic<pid_t> guarded = 0;  // a child that a module forks may end as it likes

void refuse_to_end() {
  if (guards == 0 || guarded != getpid()) return;
  io::remove_all_staging();
  const std::string call = RunningCall::title();
  std::fprintf(stderr,
               "\nplumb: %s: its module ended the program (by exit), and nothing is written; a "
               "step must return, or throw plumb::Error\n",
               call.empty() ? "a step" : call.c_str());
  _exit(exit_failed);
}

}  // namespace

ExitGuard::ExitGuard() {
  guarded = getpid();
  ++guards;
  std::atexit(refuse_to_end);
  std::at_quick_exit(refuse_to_end);
}

ExitGuard::~ExitGuard() { --guards; }

}  // namespace plumb::command
