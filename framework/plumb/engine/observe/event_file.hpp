#pragma once
/// The events of a run in files: as lines of JSON, and as a trace that Perfetto and
/// chrome://tracing show.

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "plumb/engine/observe/observer.hpp"

namespace plumb {

/// What both have in common: a file to which whole lines are written. A disk that does not take
/// them costs the file and no more.
class EventFile : public Observer {
 public:
  /// Throws Error: the file cannot be written.
  explicit EventFile(const std::filesystem::path& file);
  ~EventFile() override;
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;
  /// Why the file is not whole; empty when it is.
  std::string fault();

 protected:
  void write(const std::string& text,
             bool now);  ///< mutex_ is held; `now`: the file has it when this returns
  std::mutex mutex_;

 private:
  std::filesystem::path name_;
  std::FILE* file_;
  std::string fault_;
};

/// `--events`: one JSON object a line, each there as soon as it happens: event, time [s], and what
/// belongs to it.
class EventLines final : public EventFile {
 public:
  static constexpr const char* mark = "{\"event\":\"run_begins\",";  ///< how every such file begins
  using EventFile::EventFile;
  void event(const Event& event) override;
};

/// `--trace`: Chrome's trace format. Items lie on the track of the thread that made them, passes on
/// one of their own, on which steps lie too; those that run beside others have further ones. The
/// file is JSON once the run has ended.
class TraceFile final : public EventFile {
 public:
  static constexpr const char* mark = "{\"plumb\":\"trace of a run\",";
  explicit TraceFile(const std::filesystem::path& file);
  ~TraceFile() override;
  void event(const Event& event) override;

 private:
  void add(const std::string& object);  ///< mutex_ is held
  void name_track(int process, int track, const std::string& name);
  int track_of_step(double begin, double end);  ///< mutex_ is held
  std::set<std::pair<int, int>> named_;         ///< process, track
  std::set<int> processes_;
  std::vector<double> steps_until_;  ///< by track of steps: the end of what lies on it [s]
  int first_process_ = 0;
  bool first_ = true;  ///< nothing was added yet
};

}  // namespace plumb
