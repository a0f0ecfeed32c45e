#pragma once
/// What a run shows while it goes: a bar on a terminal, plain lines elsewhere. The bar is that of
/// the step that has run for longest; how many run beside it stands behind.

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/engine/observe/observer.hpp"

namespace spdlog {
class logger;
}

namespace plumb::command {

/// The first line of a log file.
inline constexpr const char* log_mark = "# What a run of plumb said";

/// Writes to standard error, and every line to the end of `log_file` too when one is given. Safe
/// from several threads.
class Console final : public Observer {
 public:
  Console(bool quiet, const std::string& log_file);
  ~Console() override;
  void event(const Event& event) override;
  /// Why the log file is not whole, as far as it was written; else empty.
  std::string log_fault();

 private:
  /// A step that runs.
  struct Running {
    std::string path;
    std::size_t items = 0, done = 0;
  };
  Running* running(std::string_view step);  ///< null: it passes its items on to one that runs
  void end_of(const Event& event);
  void note(const std::string& sentence);
  void draw();
  void clear();
  std::mutex mutex_;
  bool quiet_, terminal_;
  std::shared_ptr<spdlog::logger> log_;
  std::string log_fault_;             ///< why the log file is not whole
  std::vector<Running> running_;      ///< in the order in which they began
  std::map<std::string, int> notes_;  ///< how often each kind was told
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace plumb::command
