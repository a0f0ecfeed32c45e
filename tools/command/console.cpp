#include "console.hpp"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "plumb/data/io/plain_text.hpp"
#include "plumb/slam/report/weakness.hpp"

namespace plumb::command {

Console::Console(bool quiet, const std::string& log_file)
    : quiet_(quiet), terminal_(!quiet && isatty(STDERR_FILENO)) {
  auto screen = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  screen->set_pattern("%v");
  screen->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  log_ = std::make_shared<spdlog::logger>("plumb", screen);
  log_->set_level(spdlog::level::debug);
  if (!log_file.empty()) {
    std::ofstream(log_file, std::ios::app) << log_mark << '\n';
    auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(log_file, false);
    file->set_pattern("%Y-%m-%d %H:%M:%S.%e %l %v");
    log_->sinks().push_back(file);
    log_->set_error_handler([this](const std::string& fault) { log_fault_ = fault; });
  }
}

Console::~Console() {
  clear();
  log_->flush();
}

std::string Console::log_fault() {
  log_->flush();
  return log_fault_;
}

void Console::clear() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Console::draw() {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || running_.empty() || now - drawn_ < std::chrono::milliseconds(80)) return;
  drawn_ = now;
  const Running& first = running_.front();
  constexpr int width = 30;
  const std::size_t done = std::min(first.done, first.items);
  const int filled = first.items ? static_cast<int>(width * done / first.items) : 0;
  std::fprintf(stderr, "\r\033[K%-24s [%s%s] %zu/%zu", first.path.c_str(),
               std::string(filled, '#').c_str(), std::string(width - filled, ' ').c_str(), done,
               first.items);
  if (running_.size() > 1) std::fprintf(stderr, " +%zu", running_.size() - 1);
  std::fflush(stderr);
}

Console::Running* Console::running(std::string_view step) {
  const std::string path = io::plain(step);
  const auto at = std::find_if(running_.begin(), running_.end(),
                               [&](const Running& one) { return one.path == path; });
  return at == running_.end() ? nullptr : &*at;
}

void Console::event(const Event& event) {
  const std::lock_guard lock(mutex_);
  switch (event.kind) {
    case Event::Kind::step_begins:
      running_.push_back({io::plain(event.step), event.items, 0});
      return draw();
    case Event::Kind::item:
      if (Running* step = running(event.step)) step->done += event.items;
      return draw();
    case Event::Kind::step_ends:
      return end_of(event);
    case Event::Kind::pass_begins:
      clear();
      return log_->info("{}: pass {} of at most {}", io::plain(event.step), event.pass + 1,
                        event.items);
    case Event::Kind::note:
      return note(io::plain(event.sentence));
    default:
      return;
  }
}

void Console::end_of(const Event& event) {
  clear();
  const Running* step = running(event.step);
  const std::size_t items = step ? step->items : event.items;
  log_->info("[{:7.1f} s] {:<28} {:>6} item{}  {:7.2f} s", event.time + event.duration,
             io::plain(event.step), items, items == 1 ? " " : "s", event.duration);
  if (step) running_.erase(running_.begin() + (step - running_.data()));
}

void Console::note(const std::string& sentence) {
  clear();
  constexpr int most = 3;  // of one kind on the screen; the log has all
  const int told = ++notes_[kind_of_sentence(sentence)];
  log_->log(told <= most ? spdlog::level::warn : spdlog::level::debug, "note: {}{}", sentence,
            told == most ? " (more like this are not shown)" : "");
}

}  // namespace plumb::command
