#include "plumb/engine/observe/bookkeeping.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>

namespace plumb {

const char* name_of(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::run_begins:
      return "run_begins";
    case Event::Kind::step_begins:
      return "step_begins";
    case Event::Kind::item:
      return "item";
    case Event::Kind::step_ends:
      return "step_ends";
    case Event::Kind::pass_begins:
      return "pass_begins";
    case Event::Kind::note:
      return "note";
    case Event::Kind::run_ends:
      return "run_ends";
  }
  return "?";
}

int worker_number() {
  static std::atomic<int> workers = 0;
  thread_local const int number = workers++;
  return number;
}

Bookkeeping::Bookkeeping(Observer& observer)
    : observer_(observer), begin_(Clock::now()), process_(getpid()) {}

Event Bookkeeping::event(Event::Kind kind) const {
  Event event;
  event.kind = kind;
  event.time = seconds(Clock::now());
  event.process = process_;
  event.worker = worker_number();
  return event;
}

void Bookkeeping::run_begins(const std::string& pipeline, std::size_t steps) {
  Event told = event(Event::Kind::run_begins);
  told.time = 0;
  told.sentence = pipeline;
  told.items = steps;
  observer_.event(told);
}

void Bookkeeping::run_ends(const std::string& why_failed) {
  Event told = event(Event::Kind::run_ends);
  told.duration = told.time;
  told.time = 0;
  told.peak_bytes = memory_.peak();
  told.sentence = why_failed;
  for (const StepTime& time : times()) {
    told.cpu_seconds += time.cpu_seconds;
    told.items += time.items + time.remembered;
  }
  observer_.event(told);
}

void Bookkeeping::step_begins(const std::string& path, int pass, std::size_t items) {
  memory_.begin(path);
  {
    const std::lock_guard lock(mutex_);
    const auto at = time_index_.find(path);
    at_begin_[path] = at == time_index_.end() ? StepTime{} : times_[at->second];
  }
  Event told = event(Event::Kind::step_begins);
  told.step = path;
  told.pass = pass;
  told.items = items;
  observer_.event(told);
}

void Bookkeeping::step_ends(const std::string& path, int pass, double duration) {
  Event told = event(Event::Kind::step_ends);
  told.time = std::max(0.0, told.time - duration);
  told.duration = duration;
  told.step = path;
  told.pass = pass;
  told.peak_bytes = memory_.end(path);
  {
    const std::lock_guard lock(mutex_);
    StepTime& time = time_of(path);
    const StepTime& before = at_begin_[path];
    time.peak_bytes = std::max<std::size_t>(time.peak_bytes, told.peak_bytes);
    told.cpu_seconds = time.cpu_seconds - before.cpu_seconds;
    told.items = time.items + time.remembered - before.items - before.remembered;
  }
  observer_.event(told);
}

void Bookkeeping::pass_begins(const std::string& repeat, int pass, int at_most) {
  Event told = event(Event::Kind::pass_begins);
  told.step = repeat;
  told.pass = pass;
  told.items = static_cast<std::size_t>(at_most);
  observer_.event(told);
}

void Bookkeeping::item(const ItemEvent& item) {
  Event told;
  told.kind = Event::Kind::item;
  told.time = seconds(item.begin);
  told.duration = std::chrono::duration<double>(item.end - item.begin).count();
  told.step = item.step;
  told.pass = item.pass;
  told.item = item.item;
  told.process = item.process ? item.process : process_;
  told.worker = item.worker;
  told.reused = item.reused;
  told.cpu_seconds = item.cpu_seconds;
  told.peak_bytes = memory_.last();
  told.items = 1;
  {
    const std::lock_guard lock(mutex_);
    StepTime& time = time_of(item.step);
    ++(item.reused ? time.remembered : time.items);
    time.cpu_seconds += item.cpu_seconds;
    time.peak_bytes = std::max<std::size_t>(time.peak_bytes, told.peak_bytes);
  }
  observer_.event(told);
}

void Bookkeeping::all_reused(const std::string& path, int pass, std::size_t items) {
  Event told = event(Event::Kind::item);
  told.step = path;
  told.pass = pass;
  told.reused = true;
  told.items = items;
  {
    const std::lock_guard lock(mutex_);
    time_of(path).remembered += items;
  }
  if (items > 0) observer_.event(told);
}

void Bookkeeping::from_earlier_run(const std::string& path, std::size_t results) {
  const std::lock_guard lock(mutex_);
  time_of(path).earlier += results;
}

void Bookkeeping::count(const std::string& path, std::string_view what, std::uint64_t n) {
  if (n == 0) return;
  const std::lock_guard lock(mutex_);
  counts_[{path, std::string(what)}] += n;
}

void Bookkeeping::warn(const std::string& path, const std::string& sentence) {
  say(path, path + ": " + sentence);
}

void Bookkeeping::say(const std::string& path, const std::string& said) {
  {
    const std::lock_guard lock(mutex_);
    if (std::find(warnings_.begin(), warnings_.end(), said) != warnings_.end()) return;
    warnings_.push_back(said);
  }
  Event told = event(Event::Kind::note);
  told.step = path;
  told.sentence = said;
  observer_.event(told);
}

StepTime& Bookkeeping::time_of(std::string_view path) {
  const auto at = time_index_.find(path);
  if (at != time_index_.end()) return times_[at->second];
  time_index_.emplace(path, times_.size());
  return times_.emplace_back(StepTime{std::string(path)});
}

void Bookkeeping::add_time(const std::string& path, double seconds) {
  const std::lock_guard lock(mutex_);
  time_of(path).cpu_seconds += seconds;
}

std::pair<std::size_t, std::size_t> Bookkeeping::items_of(const std::string& path) const {
  const std::lock_guard lock(mutex_);
  const auto at = time_index_.find(path);
  if (at == time_index_.end()) return {0, 0};
  return {times_[at->second].items, times_[at->second].remembered};
}

void Bookkeeping::clear() {
  const std::lock_guard lock(mutex_);
  counts_.clear();
  warnings_.clear();
  times_.clear();
  time_index_.clear();
}

std::vector<StepCount> Bookkeeping::counts() const {
  const std::lock_guard lock(mutex_);
  std::vector<StepCount> counts;
  for (const auto& [key, n] : counts_) counts.push_back({key.first, key.second, n});
  return counts;
}

std::vector<std::string> Bookkeeping::warnings() const {
  const std::lock_guard lock(mutex_);
  auto sorted = warnings_;
  std::sort(sorted.begin(), sorted.end());  // threads may have said them in any order
  return sorted;
}

std::vector<StepTime> Bookkeeping::times() const {
  const std::lock_guard lock(mutex_);
  return times_;
}

}  // namespace plumb
