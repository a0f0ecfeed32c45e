#include "plumb/engine/run/runner.hpp"

#include <chrono>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/lifetime.hpp"
#include "plumb/engine/plan/loop.hpp"
#include "plumb/engine/run/parallel.hpp"
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

class Runner {
 public:
  Runner(const Plan& plan, const Registry& registry, const RunOptions& options, Observer& observer)
      : plan_(plan),
        books_(observer),
        results_(options.store, options.fresh, memory_for_results(options), options.memory > 0),
        admission_(memory_for_calls(options)),
        executor_(options.executor),
        store_(options.store),
        bound_(options.store_bound),
        lifetimes_(keeping_of(plan)),
        runs_(plan.steps.size()),
        documents_(plan.steps.size()),
        numbers_(plan.steps.size()),
        carried_(plan.repeats.size()) {
    for (const PlannedStep& step : plan.steps)
      steps_.push_back(&registry.step(step.description->name));
  }

  /// Tells its begin and its end, and why it failed if it did.
  void run() {
    books_.run_begins(plan_.name, plan_.steps.size());
    try {
      run_all();
    } catch (const std::exception& e) {
      books_.run_ends(e.what());
      throw;
    }
    books_.run_ends();
  }

  RunResult result() {
    RunResult result;
    for (std::size_t s = 0; s < plan_.steps.size(); ++s) {
      for (auto& document : documents_[s])
        result.documents.push_back({plan_.steps[s].path, document});
      for (auto& numbers : numbers_[s]) result.numbers.push_back({plan_.steps[s].path, numbers});
    }
    result.loops = std::move(loops_);
    result.warnings = books_.warnings();
    result.counts = books_.counts();
    result.times = books_.times();
    result.peak_bytes = books_.memory().peak();
    result.explained = std::move(explained_);
    return result;
  }

 private:
  void run_all() {
    const auto last = last_uses(plan_);
    for (std::size_t place = 0; place < plan_.order.size(); ++place) {
      run_item(plan_.order[place]);
      for (std::size_t s = 0; s < runs_.size(); ++s)
        if (last[s] <= place && runs_[s]) {
          runs_[s]->remember();
          runs_[s].reset();
        }
      if (store_) store_->sync();
      if (admission_.bounded()) give_memory_back();
    }
  }

  void run_item(const PlannedItem& item) {
    if (item.step < 0) return run_repeat(item.repeat);
    run_step(item.step);
    if (bound_) bound_->after_step();
  }

  Source source_of(const Wire& wire) const {
    if (wire.repeat >= 0) {
      Source source = carried_[wire.repeat][wire.carry];
      source.label = wire.label;
      return source;
    }
    return {runs_[wire.step], wire.output, wire.label};
  }

  void run_step(int index) {
    const PlannedStep& step = plan_.steps[index];
    ParameterValues values;
    for (std::size_t p = 0; p < step.parameters.size(); ++p) {
      const PlannedParameter& parameter = step.parameters[p];
      values[step.description->parameters[p].name] =
          parameter.row < 0
              ? parameter.value
              : plan_.repeats[parameter.repeat].value(parameter.row, pass_of_[parameter.repeat]);
    }
    std::vector<std::vector<Source>> inputs(step.inputs.size());
    for (std::size_t p = 0; p < inputs.size(); ++p)
      for (const Wire& wire : step.inputs[p]) inputs[p].push_back(source_of(wire));

    const auto begin = std::chrono::steady_clock::now();
    std::shared_ptr<StepRun> run;
    try {
      run = std::make_shared<StepRun>(step, *steps_[index], values, std::move(inputs),
                                      lifetimes_[index].keeping,
                                      RunState{books_, results_, admission_, executor_, pass_});
    } catch (const Error& e) {
      throw Error("step '" + step.path + "' (" + step.description->name + "): " + e.what());
    }
    const auto counted = books_.items_of(step.path);
    run->start();
    if (runs_[index]) runs_[index]->remember();  // of the pass before, which nobody asks any more
    runs_[index] = run;
    if (store_) explain(index, *run, counted);
    run->remember();
    collect(index, *run);
    if (lifetimes_[index].keeping != Keeping::passing)
      books_.step_ends(
          step.path, pass_,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }

  /// Compares what decided over the step with what did in the last run, and notes it for the next.
  void explain(int index, StepRun& run, std::pair<std::size_t, std::size_t> counted) {
    const PlannedStep& step = plan_.steps[index];
    Explained one;
    one.path = step.path;
    one.pass = pass_;
    one.passes = lifetimes_[index].keeping == Keeping::passing;
    const auto now = books_.items_of(step.path);
    one.made = now.first - counted.first;
    one.reused = now.second - counted.second;
    const Facts& facts = run.facts();
    const Facts before = store_->index()->facts(plan_.name, step.path, one.pass);
    one.why =
        before.empty() ? "this cache knows no earlier run of it" : first_difference(before, facts);
    store_->index()->set_facts(plan_.name, step.path, one.pass, facts);
    explained_.push_back(std::move(one));
  }

  void collect(int index, StepRun& run) {
    if (run.itemwise()) return;
    documents_[index].clear();
    numbers_[index].clear();
    const auto& outputs = plan_.steps[index].description->outputs;
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      const int output = static_cast<int>(o);
      if (outputs[o].type == &type_of<Document>())
        for (std::size_t k = 0; k < run.count(output); ++k)
          documents_[index].push_back(run.value(output, k).as<Document>());
      if (outputs[o].type->has_numbers && outputs[o].emission == Emission::one)
        numbers_[index].push_back(run.value(output));
    }
  }

  double condition_value(const PlannedCondition& condition) const {
    const AnyValue value = runs_[condition.step]->value(condition.output);
    for (const Number& number : value.type->code->numbers(value.value.get()))
      if (condition.metric.empty() || number.name == condition.metric) return number.value;
    throw Error(condition.origin.text() + ": step '" + plan_.steps[condition.step].path +
                "' gave no number '" + condition.metric + "' to judge the loop by");
  }

  void run_repeat(int index) {
    const PlannedRepeat& repeat = plan_.repeats[index];
    auto& carried = carried_[index];
    carried.clear();
    for (const PlannedCarry& carry : repeat.carries) carried.push_back(source_of(carry.start));
    LoopJudge judge(repeat);
    const int outer = pass_;
    for (;;) {
      const int pass = judge.passes();
      pass_of_[index] = pass;
      pass_ = pass;
      books_.pass_begins(repeat.path, pass, repeat.at_most);
      for (const PlannedItem& item : repeat.body) run_item(item);
      std::vector<double> values;
      for (const PlannedCondition& condition : repeat.conditions)
        values.push_back(condition_value(condition));
      std::vector<Source> next;
      for (const PlannedCarry& carry : repeat.carries) next.push_back(source_of(carry.next));
      carried = std::move(next);
      const auto ended = judge.after_pass(std::move(values));
      if (!ended) continue;
      pass_ = outer;
      end_loop(repeat, judge, *ended);
      return;
    }
  }

  void end_loop(const PlannedRepeat& repeat, const LoopJudge& judge, const std::string& why) {
    loops_.push_back({repeat.path, judge.passes(), why});
    const bool exhausted = !repeat.conditions.empty() && why.starts_with("at_most");
    const std::string sentence =
        repeat.path + " ended after " + counted(judge.passes(), "passes") + ": " + why;
    if (exhausted && repeat.if_exhausted == Exhausted::fail)
      throw Error(repeat.origin.text() + ": " + sentence +
                  "; allow more passes (at_most) or ask for less (until)");
    if (exhausted && repeat.if_exhausted == Exhausted::warn) books_.warn("repeat", sentence);
  }

  const Plan& plan_;
  Bookkeeping books_;
  Results results_;
  Admission admission_;
  Executor* executor_;
  Store* store_;
  SizeBound* bound_;
  std::vector<Lifetime> lifetimes_;
  std::vector<const Step*> steps_;
  std::vector<std::shared_ptr<StepRun>> runs_;  ///< by step, of the present or last pass
  std::vector<std::vector<std::shared_ptr<const Document>>> documents_;
  std::vector<std::vector<AnyValue>> numbers_;
  std::vector<std::vector<Source>> carried_;  ///< by repeat, then carry
  std::map<int, int> pass_of_;
  int pass_ = -1;  ///< of the innermost repeat that runs
  std::vector<LoopEnd> loops_;
  std::vector<Explained> explained_;
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
