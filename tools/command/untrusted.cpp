#include "untrusted.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "command_line.hpp"
#include "plumb/data/amount.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/io/fence.hpp"
#include "plumb/data/io/staged_folder.hpp"
#include "plumb/plugin/trusted_file.hpp"
#include "usage.hpp"

namespace plumb::command {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t least_memory = std::uint64_t{256} << 20;

/// Memory that is asked for beyond `bytes` is refused, which fails the step; a crash writes no
/// core.
void bound_memory(const std::string& text) {
  const std::uint64_t bytes = usage([&] { return bytes_of_text("--max-memory", text); });
  if (bytes < least_memory)
    throw UsageError("--max-memory " + text + ": is too little to run in; give 256MiB or more");
  const rlimit limit{bytes, bytes}, no_core{0, 0};
  setrlimit(RLIMIT_DATA, &limit);
  setrlimit(RLIMIT_CORE, &no_core);
}

/// The process ends when the time is over, whatever it waits for.
void bound_time(const std::string& text) {
  const auto time = usage([&] { return age_of_text("--max-time", text); });
  if (time.count() <= 0)
    throw UsageError("--max-time " + text + ": give a time above zero, as in 10min");
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(
      SIG_BLOCK, &all,
      &before);  // a signal is for the thread that waits for it (interrupt.cpp), never for this one
  std::thread([time, text] {
    std::this_thread::sleep_for(time);
    io::remove_all_staging();
    std::fprintf(stderr,
                 "\nplumb: ended after --max-time %s; what was unfinished is removed; give it more "
                 "time if you trust it\n",
                 text.c_str());
    _exit(exit_failed);
  }).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void Untrusted::add_to(Command& command) {
  command.add_flag("--untrusted", on_,
                   "For a stranger's pipeline: it reads only what --set names, uses only the "
                   "modules that Plumb came with, and has bounds of memory and time");
  command.add_option("--max-memory", memory_, "With --untrusted: memory that it may allocate")
      .needs("--untrusted")
      .capture_default_str();
  command.add_option("--max-time", time_, "With --untrusted: time that it may take")
      .needs("--untrusted")
      .capture_default_str();
}

void Untrusted::before_reading(PipelineOptions& pipeline) const {
  if (!on_) return;
  if (!plugin_path.empty())
    throw UsageError(
        "--plugin-path " + plugin_path.front().string() +
        ": a stranger's pipeline gets no modules but those that Plumb came with; leave one "
        "of --plugin-path and --untrusted out");
  bound_memory(memory_);
  bound_time(time_);
  pipeline.overlay.untrusted = true;
  std::vector<fs::path> folders = Registry::shipped_folders();
  folders.push_back(folder_of(pipeline.file));
  for (const fs::path& preset : pipeline.overlay.presets) folders.push_back(folder_of(preset));
  io::set_fence(folders);
}

Registry Untrusted::steps() const {
  return on_ ? Registry::scan(Registry::shipped_folders()) : installed_steps();
}

void Untrusted::before_running(const Plan& plan, const Registry& steps,
                               std::vector<fs::path> own) const {
  if (!on_) return;
  for (const fs::path& given : given_paths(plan)) own.push_back(given);
  own.push_back(this_library());  // the record of the run holds its hash
  own.insert(own.end(), steps.folders().begin(), steps.folders().end());
  io::set_fence(own);
}

}  // namespace plumb::command
