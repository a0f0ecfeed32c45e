#pragma once
/// What is collected over a run, and told to its observer: counts and warnings of steps, the time
/// and memory that each step took.

#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "plumb/data/counted.hpp"
#include "plumb/engine/observe/memory_watch.hpp"
#include "plumb/engine/observe/observer.hpp"

namespace plumb {

/// One line of the table of times.
struct StepTime {
  std::string path;
  std::size_t items = 0,
              remembered = 0;  ///< made; taken from what the run remembers or from the store
  double cpu_seconds = 0;      ///< of its own, without the steps that it called for
  std::size_t peak_bytes = 0;  ///< the most that was held while it ran, by the step or by others
  std::size_t earlier = 0;     ///< results that an earlier run had made, each counted once
};

/// What a step counted, over all its items and passes.
struct StepCount {
  std::string path, what;  ///< "points without a normal"
  std::uint64_t n = 0;

  std::string text() const { return path + ": " + counted(n, what); }
};

/// One call of a step that was made or reused, here or in a process that works for this one.
struct ItemEvent {
  std::string_view step, item;
  int pass = -1;
  bool reused = false;
  std::chrono::steady_clock::time_point begin,
      end;                 ///< the clock is the same in all processes of a machine
  double cpu_seconds = 0;  ///< of its own, over all threads; is added to the step's
  int process = 0;         ///< 0: this one
  int worker = 0;          ///< number of the thread in its process
};

/// Number of this thread among those of the process that have made something, from 0.
int worker_number();

/// Safe from several threads. The run begins when it is constructed.
class Bookkeeping {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Bookkeeping(Observer& observer);

  void run_begins(const std::string& pipeline, std::size_t steps);
  void run_ends(const std::string& why_failed = "");
  void step_begins(const std::string& path, int pass, std::size_t items);
  void step_ends(const std::string& path, int pass, double seconds);
  void pass_begins(const std::string& repeat, int pass, int at_most);
  void item(const ItemEvent& item);  ///< counts it and tells of it
  /// All items of a step at once, known from an earlier run without a look at them.
  void all_reused(const std::string& path, int pass, std::size_t items);

  /// So many of the results that were reused are an earlier run's.
  void from_earlier_run(const std::string& path, std::size_t results);

  void count(const std::string& path, std::string_view what, std::uint64_t n);
  void warn(const std::string& path,
            const std::string& sentence);  ///< said at once, each sentence only once
  void say(const std::string& path,
           const std::string& said);  ///< as warn, of a sentence that begins with the path already
  void add_time(const std::string& path,
                double seconds);  ///< CPU time of a step that is not an item's

  std::vector<StepCount> counts() const;
  std::vector<std::string> warnings() const;
  std::vector<StepTime> times() const;  ///< in the order in which they were first booked
  std::pair<std::size_t, std::size_t> items_of(
      const std::string& path) const;  ///< so far: made, remembered
  void clear();                        ///< forgets all that was collected
  MemoryWatch& memory() { return memory_; }

 private:
  StepTime& time_of(std::string_view path);
  double seconds(Clock::time_point at) const {
    return std::chrono::duration<double>(at - begin_).count();
  }
  Event event(Event::Kind kind) const;  ///< of now and here
  Observer& observer_;
  const Clock::time_point begin_;
  const int process_;
  MemoryWatch memory_;
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, std::uint64_t> counts_;
  std::vector<std::string> warnings_;
  std::vector<StepTime> times_;
  std::map<std::string, std::size_t, std::less<>> time_index_;
  std::map<std::string, StepTime>
      at_begin_;  ///< of the steps that run: what was booked when the pass began
};

}  // namespace plumb
