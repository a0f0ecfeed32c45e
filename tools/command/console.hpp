#pragma once
/// What a run shows while it goes: a bar on a terminal, plain lines elsewhere.

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

#include "plumb/engine/observer.hpp"

namespace spdlog {
class logger;
}

namespace plumb::command {

/// Makes a log file, in which an earlier log of plumb is replaced. Throws Error: something else is there; it cannot be written.
void begin_log(const std::filesystem::path& file);

/// Writes to standard error, and every line to the end of `log_file` too when one is given. Safe from several threads.
class Console final : public Observer {
 public:
  Console(bool quiet, const std::string& log_file);
  ~Console() override;
  void step_begins(const std::string& path, std::size_t items) override;
  void item_done(const std::string& path) override;
  void step_ends(const std::string& path, double seconds) override;
  void pass_begins(const std::string& repeat, int pass, int at_most) override;
  void note(const std::string& sentence) override;

 private:
  void draw();
  void clear();
  std::mutex mutex_;
  bool quiet_, terminal_;
  std::shared_ptr<spdlog::logger> log_;
  std::string path_;
  std::map<std::string, int> notes_;  ///< how often each kind was told
  std::size_t items_ = 0, done_ = 0;
  std::chrono::steady_clock::time_point begin_, drawn_;
};

}  // namespace plumb::command
