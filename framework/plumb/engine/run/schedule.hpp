#pragma once
/// When the steps of a plan run, and which of them at the same time.

#include <atomic>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <vector>

#include "plumb/engine/plan/level.hpp"
#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// When something would happen if the steps ran one after the other: the place in the pipeline;
/// within a repeat then the pass, from 0, and the place in its body; and so on. Compared part by
/// part.
using Turn = std::vector<std::size_t>;

/// Thrown by a step that left calls out because another one has failed. That one is told of.
struct LeftOut {};

/// What is done of a plan. Called from several threads, at the same time where the plan allows
/// that; all that was done before what a step or pass waits for is seen by it.
class Work {
 public:
  virtual ~Work() = default;
  virtual void run_step(int step, const Turn& turn) = 0;
  virtual void begin_repeat(int repeat) = 0;
  virtual void begin_pass(int repeat, int pass) = 0;
  /// All of a pass is done; whether another one follows. `turn` comes after all of the pass.
  virtual bool end_pass(int repeat, const Turn& turn) = 0;
  /// An item of the pipeline is done, with all that is in it; those that wait for it begin then.
  virtual void item_done(std::size_t place) = 0;
};

/// Runs a plan once. No thread waits for a step: whoever ends one goes on with the first, in the
/// plan's order, of all those that wait for nothing any more (level.hpp), in a repeat or not. So
/// one thread runs the plan in its order.
class Schedule {
 public:
  Schedule(const Plan& plan, Work& work);

  /// Unless `together`, one step at a time. When something fails nothing more begins, and what was
  /// thrown at the first turn, of all that was thrown, is thrown again. Throws Error when a step
  /// left calls out and none had failed.
  void run(bool together);
  /// Whether something has failed, for those that run on.
  const std::atomic<bool>& stopped() const { return stopped_; }

 private:
  /// A level that is run: the pipeline, or a repeat's body in one pass after the other.
  struct Running {
    const std::vector<PlannedItem>& items;
    Level level;
    int repeat = -1;
    Running* around = nullptr;  ///< where the repeat lies, and its place there; null: nowhere
    std::size_t place = 0, pass = 0;
    std::vector<std::size_t> waits = {};  ///< by item: so many that it waits for are not done
    std::size_t left = 0;                 ///< so many are not done
  };
  struct Ready {
    Running* level;
    std::size_t item;
  };

  std::size_t next();
  std::size_t begin(Running& level, std::size_t item, const Turn& turn);
  std::size_t begin_items(Running& level);
  std::size_t begin_pass(Running& body);
  std::size_t end_pass(Running& body);
  std::size_t done(Running& level, std::size_t item);
  template <class What>
  std::size_t guarded(const Turn& turn, const What& what);
  static Turn turn_of(const Running& level);

  Work& work_;
  Running pipeline_;
  std::vector<Running> bodies_;  ///< by repeat
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;             ///< of what follows, and of `waits` and `left`
  std::map<Turn, Ready> ready_;  ///< what may begin
  std::exception_ptr failure_;
  Turn failed_at_;
};

}  // namespace plumb
