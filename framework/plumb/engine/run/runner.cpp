#include "plumb/engine/run/runner.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/lifetime.hpp"
#include "plumb/engine/plan/loop.hpp"
#include "plumb/engine/plan/wires.hpp"
#include "plumb/engine/run/admission.hpp"
#include "plumb/engine/run/gathered.hpp"
#include "plumb/engine/run/local_executor.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/engine/run/schedule.hpp"
#include "plumb/engine/run/step_run.hpp"
#include "plumb/store/index.hpp"
#include "plumb/store/size_bound.hpp"

namespace plumb {
namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;

/// What stays in memory of what the store has: little where memory is bounded, so that it does not
/// grow with the trajectory.
std::size_t memory_for_results(const RunOptions& options) {
  return options.memory == 0 ? 1024 * mebibyte : std::max(options.memory / 32, 16 * mebibyte);
}

/// For the calls that run at a time; the rest is for steps on whole collections and for the program
/// itself.
std::size_t memory_for_calls(const RunOptions& options) { return options.memory / 2; }

/// What is known of a step or a repeat is written by the thread that runs it and read by those that
/// wait for it.
class Runner final : public Work {
 public:
  Runner(const Plan& plan, const Registry& registry, const RunOptions& options, Observer& observer)
      : plan_(plan),
        options_(options),
        books_(observer),
        results_(options.store, options.fresh, memory_for_results(options), options.memory > 0),
        here_(memory_for_calls(options)),
        lifetimes_(keeping_of(plan)),
        users_(users_of(plan)),
        repeat_of_(plan.steps.size(), -1),
        runs_(plan.steps.size()),
        judges_(plan.repeats.size()),
        passes_(plan.repeats.size(), 0),
        carried_(plan.repeats.size()),
        gathered_(plan),
        schedule_(plan, *this) {
    for (const PlannedStep& step : plan.steps)
      steps_.push_back(&registry.step(step.description->name));
    visit_steps(plan, plan.order, -1, [&](int step, int repeat) { repeat_of_[step] = repeat; });
  }

  /// Tells its begin and its end, and why it failed if it did.
  void run() {
    books_.run_begins(plan_.name, plan_.steps.size());
    try {
      // Memory is shared out to calls, and nobody knows what a step on whole collections needs.
      schedule_.run(options_.memory == 0);
    } catch (const std::exception& e) {
      books_.run_ends(e.what());
      throw;
    }
    books_.run_ends();
  }

  RunResult result() { return gathered_.result(books_); }

  void run_step(int index, const Turn& turn) override {
    const PlannedStep& step = plan_.steps[index];
    const int pass = repeat_of_[index] < 0 ? -1 : passes_[repeat_of_[index]];
    auto inputs = inputs_of(step);
    const auto begin = std::chrono::steady_clock::now();
    std::shared_ptr<StepRun> run;
    try {
      run = std::make_shared<StepRun>(
          step, *steps_[index], values_of(step), std::move(inputs), lifetimes_[index].keeping,
          RunState{books_, results_, executor(), pass, &schedule_.stopped()});
    } catch (const Error& e) {
      throw Error("step '" + step.path + "' (" + step.description->name + "): " + e.what());
    }
    const auto counted = books_.items_of(step.path);
    run->start();
    runs_[index] = run;
    if (options_.store) explain(index, *run, counted, turn);
    run->remember();
    gathered_.add(index, *run);
    if (lifetimes_[index].keeping != Keeping::passing)
      books_.step_ends(
          step.path, pass,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    hold_bound();
  }

  void begin_repeat(int index) override {
    const PlannedRepeat& repeat = plan_.repeats[index];
    carried_[index].clear();
    for (const PlannedCarry& carry : repeat.carries)
      carried_[index].push_back(source_of(carry.start));
    judges_[index].emplace(repeat);
  }

  void begin_pass(int index, int pass) override {
    passes_[index] = pass;
    books_.pass_begins(plan_.repeats[index].path, pass, plan_.repeats[index].at_most);
  }

  bool end_pass(int index, const Turn& turn) override {
    const PlannedRepeat& repeat = plan_.repeats[index];
    std::vector<double> values;
    for (const PlannedCondition& condition : repeat.conditions)
      values.push_back(condition_value(condition));
    std::vector<Source> next;
    for (const PlannedCarry& carry : repeat.carries) next.push_back(source_of(carry.next));
    carried_[index] = std::move(next);
    const auto ended = judges_[index]->after_pass(std::move(values));
    if (!ended) return true;
    carried_[index].clear();
    end_loop(repeat, judges_[index]->passes(), *ended, turn);
    return false;
  }

  void item_done(std::size_t place) override {
    release(place);
    if (options_.store) options_.store->sync();
    if (options_.memory > 0) give_memory_back();
  }

 private:
  Executor& executor() {
    return options_.executor ? *options_.executor : static_cast<Executor&>(here_);
  }

  /// Lets go of those steps that an item of the pipeline was the last to ask.
  void release(std::size_t place) {
    std::vector<std::shared_ptr<StepRun>> over;  // declared before the lock: freed after it
    const std::lock_guard lock(users_mutex_);
    for (std::size_t s = 0; s < users_.size(); ++s)
      if (std::erase(users_[s], place) > 0 && users_[s].empty())
        over.push_back(std::move(runs_[s]));
  }

  void hold_bound() {
    if (!options_.store_bound) return;
    const std::lock_guard lock(bound_mutex_);
    options_.store_bound->after_step();
  }

  Source source_of(const Wire& wire) const {
    if (wire.repeat >= 0) {
      Source source = carried_[wire.repeat][wire.carry];
      source.label = wire.label;
      return source;
    }
    return {runs_[wire.step], wire.output, wire.label};
  }

  std::vector<std::vector<Source>> inputs_of(const PlannedStep& step) const {
    std::vector<std::vector<Source>> inputs(step.inputs.size());
    for (std::size_t p = 0; p < inputs.size(); ++p)
      for (const Wire& wire : step.inputs[p]) inputs[p].push_back(source_of(wire));
    return inputs;
  }

  ParameterValues values_of(const PlannedStep& step) const {
    ParameterValues values;
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      const PlannedParameter& parameter = step.parameters[p];
      values[step.description->parameters[p].name] =
          parameter.row < 0
              ? parameter.value
              : plan_.repeats[parameter.repeat].value(parameter.row, passes_[parameter.repeat]);
    }
    return values;
  }

  /// Compares what decided over the step with what did in the last run, and notes it for the next.
  void explain(int index, StepRun& run, std::pair<std::size_t, std::size_t> counted,
               const Turn& turn) {
    const PlannedStep& step = plan_.steps[index];
    Index& known = *options_.store->index();
    Explained one;
    one.path = step.path;
    one.pass = repeat_of_[index] < 0 ? -1 : passes_[repeat_of_[index]];
    one.passes = lifetimes_[index].keeping == Keeping::passing;
    const auto now = books_.items_of(step.path);
    if (!one.passes) {  // else others may ask the pass before meanwhile
      one.made = now.first - counted.first;
      one.reused = now.second - counted.second;
    }
    const Facts& facts = run.facts();
    const Facts before = known.facts(plan_.name, step.path, one.pass);
    one.why =
        before.empty() ? "this cache knows no earlier run of it" : first_difference(before, facts);
    known.set_facts(plan_.name, step.path, one.pass, facts);
    gathered_.add(turn, std::move(one));
  }

  double condition_value(const PlannedCondition& condition) const {
    const AnyValue value = runs_[condition.step]->value(condition.output);
    for (const Number& number : value.type->code->numbers(value.value.get()))
      if (condition.metric.empty() || number.name == condition.metric) return number.value;
    throw Error(condition.origin.text() + ": step '" + plan_.steps[condition.step].path +
                "' gave no number '" + condition.metric + "' to judge the loop by");
  }

  void end_loop(const PlannedRepeat& repeat, int passes, const std::string& why, const Turn& turn) {
    gathered_.add(turn, LoopEnd{repeat.path, passes, why});
    const bool exhausted = !repeat.conditions.empty() && why.starts_with("at_most");
    const std::string sentence =
        repeat.path + " ended after " + counted(passes, "passes") + ": " + why;
    if (exhausted && repeat.if_exhausted == Exhausted::fail)
      throw Error(repeat.origin.text() + ": " + sentence +
                  "; allow more passes (at_most) or ask for less (until)");
    if (exhausted && repeat.if_exhausted == Exhausted::warn) books_.warn("repeat", sentence);
  }

  const Plan& plan_;
  const RunOptions& options_;
  Bookkeeping books_;
  Results results_;
  LocalExecutor here_;
  std::vector<Lifetime> lifetimes_;
  std::vector<const Step*> steps_;
  std::vector<std::vector<std::size_t>> users_;   ///< by step: places that may still ask it
  std::vector<int> repeat_of_;                    ///< by step: the innermost around it
  std::vector<std::shared_ptr<StepRun>> runs_;    ///< by step, of the present or last pass
  std::vector<std::optional<LoopJudge>> judges_;  ///< by repeat
  std::vector<int> passes_;                       ///< by repeat: the present one
  std::vector<std::vector<Source>> carried_;      ///< by repeat, then carry
  std::mutex users_mutex_, bound_mutex_;
  Gathered gathered_;
  Schedule schedule_;
};

}  // namespace

RunResult run_plan(const Plan& plan, const Registry& registry, const RunOptions& options,
                   Observer& observer) {
  const auto begin = std::chrono::steady_clock::now();
  if (options.memory > 0) bound_allocator();
  RunResult result;
  with_threads(options.threads, [&] {
    Runner runner(plan, registry, options, observer);
    runner.run();
    result = runner.result();
  });
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace plumb
