#include "exit_guard.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "command.hpp"
#include "plumb/data/io/staged_folder.hpp"
#include "plumb/engine/running_call.hpp"

namespace plumb::command {
namespace {

std::atomic<int> armed = 0;

void end() {
  if (armed == 0) return;
  io::remove_all_staging();
  const std::string call = RunningCall::title();
  std::fprintf(stderr, "\nplumb: %s: its module ended the program (by exit), and nothing is written; a step must return, or throw plumb::Error\n",
               call.empty() ? "a step" : call.c_str());
  _exit(exit_failed);
}

}  // namespace

ExitGuard::ExitGuard() {
  ++armed;
  std::atexit(end);
  std::at_quick_exit(end);
}

ExitGuard::~ExitGuard() { --armed; }

}  // namespace plumb::command
