#include "plumb/engine/observe/event_file.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "plumb/data/error.hpp"

namespace plumb {
namespace {

using Json = nlohmann::ordered_json;
using Kind = Event::Kind;

/// On one line; bytes that are no UTF-8 (a path may hold any) become U+FFFD.
std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double microseconds(double seconds) { return std::round(1e9 * seconds) / 1e3; }

// The worker with number n is on track n + 1.
constexpr int steps_track = 0;
constexpr int more_steps_track = 1'000'000;  ///< and on, of steps that run beside others

}  // namespace

EventFile::EventFile(const std::filesystem::path& file)
    : name_(file), file_(std::fopen(file.c_str(), "we")) {
  if (!file_)
    throw Error(file.string() + ": cannot be written (" + std::strerror(errno) +
                "); name a file in a folder that exists");
}

EventFile::~EventFile() {
  if (file_) std::fclose(file_);
}

void EventFile::write(const std::string& text, bool now) {
  if (!fault_.empty() || !file_) return;
  if (std::fwrite(text.data(), 1, text.size(), file_) == text.size() &&
      (!now || std::fflush(file_) == 0))
    return;
  fault_ = name_.string() + ": is not whole: " + std::strerror(errno);
}

std::string EventFile::fault() {
  const std::lock_guard lock(mutex_);
  if (fault_.empty() && file_ && std::fflush(file_) != 0)
    fault_ = name_.string() + ": is not whole: " + std::strerror(errno);
  return fault_;
}

void EventLines::event(const Event& event) {
  Json json{{"event", name_of(event.kind)}, {"time", event.time}};
  const bool item = event.kind == Kind::item,
             ends = event.kind == Kind::step_ends || event.kind == Kind::run_ends;
  if (item || ends) json["duration"] = event.duration;
  if (!event.step.empty()) json["step"] = event.step;
  if (event.pass >= 0) json["pass"] = event.pass;
  if (item) json["item"] = event.item;
  json["process"] = event.process;
  json["worker"] = event.worker;
  if (item) json["reused"] = event.reused;
  if (item || ends) {
    json["cpu_seconds"] = event.cpu_seconds;
    json["peak_bytes"] = event.peak_bytes;
  }
  if (item ? event.items != 1 : event.kind != Kind::note) json["items"] = event.items;
  if (!event.sentence.empty()) json["sentence"] = event.sentence;
  const std::string line = line_of(json) + "\n";
  const std::lock_guard lock(mutex_);
  write(line, true);
}

TraceFile::TraceFile(const std::filesystem::path& file) : EventFile(file) {
  write(std::string(mark) + "\"displayTimeUnit\":\"ms\",\"traceEvents\":[", false);
}

TraceFile::~TraceFile() {
  const std::lock_guard lock(mutex_);
  write("\n]}\n", true);
}

void TraceFile::add(const std::string& object) {
  write((first_ ? "\n" : ",\n") + object, false);
  first_ = false;
}

void TraceFile::name_track(int process, int track, const std::string& name) {
  if (!named_.insert({process, track}).second) return;
  const auto tell = [&](const char* what, Json args) {
    add(line_of(Json{
        {"ph", "M"}, {"pid", process}, {"tid", track}, {"name", what}, {"args", std::move(args)}}));
  };
  if (processes_.insert(process).second) {
    if (!first_process_) first_process_ = process;
    tell("process_name",
         {{"name", process == first_process_ ? "plumb run"
                                             : "plumb worker process " + std::to_string(process)}});
  }
  tell("thread_name", {{"name", name}});
  const bool of_worker = track > steps_track && track < more_steps_track;
  tell("thread_sort_index", {{"sort_index", of_worker ? track : track - 2 * more_steps_track}});
}

/// Spans on one track must not overlap. They are told of in about the order in which they end.
int TraceFile::track_of_step(double begin, double end) {
  std::size_t k = 0;
  while (k < steps_until_.size() && steps_until_[k] > begin) ++k;
  if (k == steps_until_.size()) steps_until_.push_back(0);
  steps_until_[k] = end;
  return k == 0 ? steps_track : more_steps_track + static_cast<int>(k);
}

void TraceFile::event(const Event& event) {
  if (event.kind == Kind::step_begins || event.kind == Kind::run_begins)
    return;  // said where they end
  const bool item = event.kind == Kind::item,
             span = item || event.kind == Kind::step_ends || event.kind == Kind::run_ends;
  std::string name(event.step);
  if (event.kind == Kind::run_ends) name = "run";
  if (event.kind == Kind::note) name = event.sentence;
  if (event.kind == Kind::pass_begins) name += ": pass " + std::to_string(event.pass + 1);
  Json json{{"ph", span ? "X" : "i"}, {"name", name},       {"cat", name_of(event.kind)},
            {"pid", event.process},   {"tid", steps_track}, {"ts", microseconds(event.time)}};
  if (span)
    json["dur"] = microseconds(event.duration);
  else
    json["s"] = "p";  // across the process's tracks
  Json args = Json::object();
  if (!event.step.empty()) args["step"] = event.step;
  if (event.pass >= 0) args["pass"] = event.pass;
  if (item) args["item"] = event.item, args["reused"] = event.reused;
  if (span) args["cpu_seconds"] = event.cpu_seconds, args["peak_bytes"] = event.peak_bytes;
  if (span && !item) args["items"] = event.items;
  if (!event.sentence.empty()) args["sentence"] = event.sentence;
  json["args"] = std::move(args);
  const std::lock_guard lock(mutex_);
  const int track = item ? event.worker + 1
                    : event.kind == Kind::step_ends
                        ? track_of_step(event.time, event.time + event.duration)
                        : steps_track;
  json["tid"] = track;
  name_track(event.process, track,
             item                   ? "worker " + std::to_string(event.worker)
             : track == steps_track ? "steps"
                                    : "steps " + std::to_string(track - more_steps_track + 1));
  add(line_of(json));
}

}  // namespace plumb
