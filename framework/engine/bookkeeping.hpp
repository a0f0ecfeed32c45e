#pragma once
/// What is collected over a run: counts and warnings of steps, and the time that each step took.

#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "plumb/engine/observer.hpp"

namespace plumb {

/// One line of the table of times.
struct StepTime {
  std::string path;
  std::size_t items = 0, remembered = 0;  ///< made; taken from what the run remembers
  double cpu_seconds = 0;                 ///< of its own, without the steps that it called for
};

/// What a step counted, over all its items and passes.
struct StepCount {
  std::string path, what;  ///< "points without a normal"
  std::uint64_t n = 0;

  std::string text() const { return path + ": " + std::to_string(n) + " " + what; }
};

/// Safe from several threads.
class Bookkeeping {
 public:
  explicit Bookkeeping(Observer& observer) : observer_(observer) {}
  Observer& observer() { return observer_; }

  void count(const std::string& path, std::string_view what, std::uint64_t n);
  void warn(const std::string& path, const std::string& sentence);  ///< said at once, each sentence only once
  void add_time(const std::string& path, double seconds);
  void add_item(const std::string& path, bool remembered);

  std::vector<StepCount> counts() const;
  std::vector<std::string> warnings() const;
  std::vector<StepTime> times() const;      ///< in the order in which steps first ran

 private:
  StepTime& time_of(const std::string& path);
  Observer& observer_;
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::uint64_t> counts_;
  std::vector<std::string> warnings_;
  std::vector<StepTime> times_;
  std::map<std::string, std::size_t> time_index_;
};

}  // namespace plumb
