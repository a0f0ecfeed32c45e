#pragma once
/// What a run tells while it goes: one stream of events that feeds progress, log, event file and
/// trace.

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb {

/// One thing that happened. The texts live as long as the call that gets the event. What does not
/// belong to its kind is as it stands here.
struct Event {
  enum class Kind {
    run_begins,   ///< sentence: the pipeline's name; items: its steps
    step_begins,  ///< items: 1 for a step on whole collections
    item,         ///< one call of a step was made or reused
    step_ends,    ///< items, cpu_seconds and peak_bytes are of this pass
    pass_begins,  ///< step: the repeat's path; items: passes at most
    note,         ///< a sentence that is worth knowing; the run goes on
    run_ends,     ///< sentence: empty, or why it failed
  };
  Kind kind = Kind::note;
  double time = 0;        ///< when it began [s], from the begin of the run
  double duration = 0;    ///< [s]; 0 for what is a moment
  std::string_view step;  ///< path: "coarse.matches"
  int pass = -1;  ///< of the innermost repeat around the step, from 0; -1 outside of repeats
  std::string_view item;  ///< "edge 3-4", "frame 7"; empty for a step on whole collections
  int process = 0;        ///< id of the process in which it was made
  int worker = 0;         ///< number of the thread in that process, from 0
  bool reused = false;    ///< taken from memory or the store, not made
  double cpu_seconds =
      0;  ///< of its own, over all threads, without what it called for of other steps
  std::uint64_t peak_bytes = 0;  ///< resident memory without mapped files, of all processes
  std::size_t items = 0;
  std::string_view sentence;
};

const char* name_of(Event::Kind kind);  ///< "step_begins"

/// Receives events; calls may come from several threads at once. Within a step, step_begins comes
/// first and step_ends last; steps may run at the same time.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void event(const Event& event) = 0;
};

/// Passes each event on to all of a list, in order. The list may be empty.
class Observers final : public Observer {
 public:
  explicit Observers(std::vector<Observer*> list = {}) : list_(std::move(list)) {}
  void event(const Event& event) override {
    for (Observer* one : list_) one->event(event);
  }

 private:
  std::vector<Observer*> list_;
};

}  // namespace plumb
