#include "console.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "plumb/data/error.hpp"
#include "plumb/report/weakness.hpp"

namespace plumb::command {

namespace {

constexpr const char* log_mark = "# What a run of plumb said";

}  // namespace

void begin_log(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::string first;
  if (std::ifstream earlier(file); earlier) std::getline(earlier, first);
  std::error_code error;
  if (fs::exists(file, error) && !(fs::is_regular_file(file) && (fs::file_size(file) == 0 || first == log_mark)))
    throw Error("--log " + file.string() + ": exists and is no log of plumb; name another file");
  std::ofstream out(file);
  out << log_mark << '\n';
  out.close();
  if (!out) throw Error("--log " + file.string() + ": cannot be written; name a file in a folder that exists");
}

Console::Console(bool quiet, const std::string& log_file)
    : quiet_(quiet), terminal_(!quiet && isatty(STDERR_FILENO)), begin_(std::chrono::steady_clock::now()) {
  auto screen = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  screen->set_pattern("%v");
  screen->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  log_ = std::make_shared<spdlog::logger>("plumb", screen);
  log_->set_level(spdlog::level::debug);
  if (!log_file.empty()) {
    auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(log_file, false);
    file->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
    log_->sinks().push_back(file);
  }
}

Console::~Console() {
  clear();
  log_->flush();
}

void Console::clear() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Console::draw() {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || now - drawn_ < std::chrono::milliseconds(80)) return;
  drawn_ = now;
  constexpr int width = 30;
  const int filled = items_ ? static_cast<int>(width * done_ / items_) : 0;
  std::fprintf(stderr, "\r\033[K%-24s [%s%s] %zu/%zu", path_.c_str(), std::string(filled, '#').c_str(),
               std::string(width - filled, ' ').c_str(), done_, items_);
  std::fflush(stderr);
}

void Console::step_begins(const std::string& path, std::size_t items) {
  const std::lock_guard lock(mutex_);
  path_ = path;
  items_ = items;
  done_ = 0;
  draw();
}

void Console::item_done(const std::string&) {
  const std::lock_guard lock(mutex_);
  ++done_;
  draw();
}

void Console::step_ends(const std::string& path, double seconds) {
  const std::lock_guard lock(mutex_);
  clear();
  const double since = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  log_->info("[{:7.1f} s] {:<28} {:>6} item{}  {:7.2f} s", since, path, items_, items_ == 1 ? " " : "s", seconds);
}

void Console::pass_begins(const std::string& repeat, int pass, int at_most) {
  const std::lock_guard lock(mutex_);
  clear();
  log_->info("{}: pass {} of at most {}", repeat, pass + 1, at_most);
}

void Console::note(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  clear();
  constexpr int most = 3;  // of one kind on the screen; the log has all
  const int told = ++notes_[kind_of_sentence(sentence)];
  log_->log(told <= most ? spdlog::level::warn : spdlog::level::debug, "note: {}{}", sentence,
            told == most ? " (more like this are not shown)" : "");
}

}  // namespace plumb::command
