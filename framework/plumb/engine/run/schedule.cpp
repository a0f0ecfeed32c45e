#include "plumb/engine/run/schedule.hpp"

#include "plumb/data/error.hpp"
#include "plumb/engine/run/parallel.hpp"

namespace plumb {

Schedule::Schedule(const Plan& plan, Work& work)
    : work_(work), pipeline_{plan.order, level_of(plan, plan.order)} {
  bodies_.reserve(plan.repeats.size());
  for (const PlannedRepeat& repeat : plan.repeats)
    bodies_.push_back({repeat.body, level_of(plan, repeat.body), static_cast<int>(bodies_.size())});
}

void Schedule::run(bool together) {
  const std::size_t first = begin_items(pipeline_);
  if (together)
    run_tasks(first, [this] { return next(); });
  else
    for (std::size_t due = first; due > 0; --due) due += next();
  if (failure_) std::rethrow_exception(failure_);
  if (pipeline_.left > 0)
    throw Error(
        "a step left calls out although none has failed, and its results are not whole; this is a "
        "fault of Plumb: report it with the pipeline, and run again");
}

/// Of the pipeline: none. Of a body: that of the repeat, and the pass.
Turn Schedule::turn_of(const Running& level) {
  if (!level.around) return {};
  Turn turn = turn_of(*level.around);
  turn.insert(turn.end(), {level.place, level.pass});
  return turn;
}

/// Runs the first item that may begin. Returns how many more may then: this is asked once for each.
std::size_t Schedule::next() {
  std::unique_lock lock(mutex_);
  if (stopped_ || ready_.empty()) return 0;
  const auto first = ready_.extract(ready_.begin());
  lock.unlock();
  const Turn& turn = first.key();
  const Ready& at = first.mapped();
  return guarded(turn, [&] { return begin(*at.level, at.item, turn); });
}

std::size_t Schedule::begin(Running& level, std::size_t item, const Turn& turn) {
  const PlannedItem& planned = level.items[item];
  if (planned.step >= 0) {
    work_.run_step(planned.step, turn);
    return done(level, item);
  }
  Running& body = bodies_[planned.repeat];
  body.around = &level;
  body.place = item;
  body.pass = 0;
  work_.begin_repeat(planned.repeat);
  return begin_pass(body);
}

/// Lets those items begin that wait for no other.
std::size_t Schedule::begin_items(Running& level) {
  const std::lock_guard lock(mutex_);
  level.left = level.items.size();
  level.waits.clear();
  for (const auto& before : level.level.before) level.waits.push_back(before.size());
  Turn turn = turn_of(level);
  turn.push_back(0);
  std::size_t ready = 0;
  for (std::size_t k = 0; k < level.items.size(); ++k) {
    if (level.waits[k] > 0) continue;
    turn.back() = k;
    ready_[turn] = {&level, k};
    ++ready;
  }
  return ready;
}

std::size_t Schedule::begin_pass(Running& body) {
  work_.begin_pass(body.repeat, static_cast<int>(body.pass));
  return body.items.empty() ? end_pass(body) : begin_items(body);
}

std::size_t Schedule::end_pass(Running& body) {
  ++body.pass;
  const Turn turn = turn_of(body);  // also after what the last pass holds
  return guarded(turn, [&] {
    return work_.end_pass(body.repeat, turn) ? begin_pass(body) : done(*body.around, body.place);
  });
}

/// Lets those items begin that waited for this one alone; after the last of a body, what follows.
std::size_t Schedule::done(Running& level, std::size_t item) {
  if (stopped_) return 0;
  if (!level.around) work_.item_done(item);
  std::size_t ready = 0;
  bool over = false;
  {
    const std::lock_guard lock(mutex_);
    Turn turn = turn_of(level);
    turn.push_back(0);
    for (const std::size_t later : level.level.after[item]) {
      if (--level.waits[later] > 0) continue;
      turn.back() = later;
      ready_[turn] = {&level, later};
      ++ready;
    }
    over = --level.left == 0;
  }
  return over && level.around ? end_pass(level) : ready;
}

template <class What>
std::size_t Schedule::guarded(const Turn& turn, const What& what) {
  try {
    return what();
  } catch (const LeftOut&) {
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failure_ || turn < failed_at_) {
      failure_ = std::current_exception();
      failed_at_ = turn;
    }
    stopped_ = true;
  }
  return 0;
}

}  // namespace plumb
