/// A step with its inputs joined: what is common to steps on items and on whole collections.
#include "plumb/engine/run/step_run.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/schedule.hpp"

namespace plumb {

StepRun::StepRun(const PlannedStep& plan, const Step& step, ParameterValues values,
                 std::vector<std::vector<Source>> inputs, Keeping keeping, RunState state)
    : plan_(plan),
      step_(step),
      values_(std::move(values)),
      params_(step.parameters(values_)),
      base_key_(step_key(*plan.description, values_)),
      files_key_(files_key(*plan.description, values_)),
      inputs_(std::move(inputs)),
      keeping_(keeping),
      state_(std::move(state)) {}

bool StepRun::lazy() const {
  for (const auto& output : plan_.description->outputs)
    if (output.emission == Emission::lazy) return true;
  return false;
}

std::string StepRun::item_name(std::size_t k) {
  if (!itemwise()) return "";
  const ItemPlace place = place_of(k);
  const std::string& kind = plan_.description->items->name;
  return own_list() ? kind + " " + std::to_string(place.i) + "-" + std::to_string(place.j)
                    : kind + " " + std::to_string(k);
}

std::string StepRun::title(std::size_t k) {
  const std::string item = item_name(k);
  return "step '" + plan_.path + "' (" + plan_.description->name + ")" +
         (item.empty() ? "" : ", " + item);
}

void StepRun::start() {
  if (!lazy() && recall()) return;
  if (itemwise())
    start_items();
  else
    start_whole();
  if (lazy()) recall();                           // what its values counted
  if (dropped_) recall_key_ = find_recall_key();  // the next run may do better: others must see it
}

/// Of a step that was recalled, opened when somebody asks.
const AnyValue& StepRun::list() {
  ready();
  if (recalled_)
    std::call_once(listed_, [this] {
      if (!list_source_.run) return;
      AnyValue list = list_source_.run->value(list_source_.output);
      if (itemwise() && list.type->code->list->size(list.value.get()) != items_)
        throw NestedError("step '" + plan_.path +
                          "': what the cache remembers of it does not fit its items; run with "
                          "--refresh");
      list_ = std::move(list);
    });
  return list_;
}

void StepRun::join() {
  if (keeping_ == Keeping::passing)
    ready();
  else
    find_inputs();
}

void StepRun::find_inputs() {
  if (itemwise()) find_items(), require_ends();
  if (keeping_ == Keeping::passing) asked_.push_back(std::make_unique<std::atomic<bool>[]>(items_));
}

/// Whether a value that is made whenever it is asked for is asked for the first time, so that what
/// it counts is to be said.
bool StepRun::first_asked(std::size_t output, std::size_t k) {
  return !asked_[output][k].exchange(true) && !said_in_full_;
}

/// "" when a result has the outputs of this step, with values of their types and as many; what is
/// wrong with it otherwise. What lies in a store was perhaps not made by the step.
std::string StepRun::misfit_of(const StoredResult& result) const {
  const auto& outputs = plan_.description->outputs;
  if (const std::size_t n = result.outputs.size(); n != outputs.size())
    return "has " + counted(n, "outputs") + " where the step has " + std::to_string(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const auto& values = result.outputs[o];
    for (const AnyValue& value : values)
      if (value.type != outputs[o].type)
        return std::string("holds ") + value.type->name + " where the step gives " +
               outputs[o].type->name;
    if (const auto many = values_of(o); many && values.size() != *many)
      return "holds " + counted(values.size(), "values") + " of its output '" + outputs[o].name +
             "' where the step gives " + std::to_string(*many);
  }
  return "";
}

/// How many values of an output are in a result of this step; none when only the step knows.
std::optional<std::size_t> StepRun::values_of(std::size_t output) const {
  const Emission emission = plan_.description->outputs[output].emission;
  if (emission == Emission::one) return 1;
  if (emission == Emission::lazy) return 0;
  if (output < whole_keys_.size()) return whole_keys_[output].size();
  const Source* over = source_over(output);
  return over ? std::optional(over->run->count(over->output)) : std::nullopt;
}

SharedResult StepRun::find(const Hash128& key) {
  return state_.results.find(key, [this](const StoredResult& result) { return misfit_of(result); });
}

/// What an earlier run or another process made: what its step said then is said again.
void StepRun::say_again(const StoredResult& result) {
  note(result);
  for (const auto& [what, n] : result.counts) state_.books.count(plan_.path, what, n);
  for (const std::string& sentence : result.warnings) state_.books.warn(plan_.path, sentence);
}

StoredResult StepRun::result_of(std::vector<PortOutput>& outputs, StoredResult said) const {
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const Emission emission = plan_.description->outputs[o].emission;
    if (emission == Emission::one)
      said.outputs.push_back({std::move(outputs[o].one)});
    else
      said.outputs.push_back(std::move(outputs[o].many));
  }
  return said;
}

/// Keeps a result and returns it; it is `pin` too, to be held, unless the store took it.
SharedResult StepRun::kept(const Hash128& key, StoredResult result, SharedResult& pin) {
  Results& results = state_.results;
  if (results.store())
    pin = results.keep(key, std::move(result), plan_.description->name);
  else if (keeping_ == Keeping::remembered)
    pin = results.remember(key, std::move(result));
  else
    pin = std::make_shared<const StoredResult>(std::move(result));
  SharedResult made = pin;
  if (results.in_store(key)) pin.reset();
  return made;
}

void StepRun::make_here(std::size_t k) {
  const Stopwatch watch(state_.books, plan_.path);
  StoredResult said;
  auto outputs = call(k, &said);
  note(said);
  if (itemwise())
    kept(kept_keys_[k], result_of(outputs, std::move(said)), pins_[k]);
  else
    take_whole(std::move(outputs), std::move(said));
  Stopwatch::item(item_name(k), state_.pass, false);
}

/// Has calls made; what fails is in failures_. Calls that are left out need a reason: this step
/// fails, or another one did.
void StepRun::make(const std::vector<std::size_t>& calls) {
  std::size_t told = 0;
  const bool begins = !stopped();   // else it may not even be known what is missing
  if (state_.executor.elsewhere())  // what workers put into the store is to stay there
    for (const std::size_t k : calls) state_.results.store()->hold({&key_of_call(k), 1});
  if (begins && !calls.empty())
    state_.executor.make(*this, calls, [&](std::size_t k, const std::string& fault) {
      ++told;
      if (!fault.empty()) failures_.add(k, fault);
    });
  if ((!begins || told < calls.size()) && !failures_.end_run()) throw LeftOut();
}

std::size_t StepRun::count(int output) {
  if (itemwise()) return items();
  return whole_keys_[output].size();
}

AnyValue StepRun::value(int output, std::size_t k) {
  ready();
  if (!numbers_.empty() && numbers_[output]) return numbers_[output];
  if (itemwise())
    return keeping_ == Keeping::passing ? pass(k)[output] : fetch(k)->outputs[output].at(0);
  if (plan_.description->outputs[output].emission != Emission::lazy)
    return whole()->outputs[output].at(k);
  const Stopwatch watch(state_.books, plan_.path);
  const bool first = first_asked(output, k);
  StoredResult said;
  ItemContext context(
      state_.books, plan_.path, [&] { return whole_keys_[output][k].low; }, first && !state_.passed,
      &said);
  AnyValue value;
  try {
    value = lazy_[output].open(k, context);
    require_sound(value, static_cast<std::size_t>(output));
  } catch (const std::exception& e) {
    if (first) note_first(said);
    throw NestedError("step '" + plan_.path + "' (" + plan_.description->name +
                      "): " + sentence_of(e));
  }
  passed_bytes_ = std::max(passed_bytes_.load(), value.type->code->bytes(value.value.get()));
  if (first) note_first(said);
  if (first && state_.passed) state_.passed(*this, output, k, said);
  return value;
}

Hash128 StepRun::key(int output, std::size_t k) {
  ready();
  if (!itemwise()) return whole_keys_[output][k];
  return joined_key(keeping_ == Keeping::passing ? call_key(k) : kept_keys_[k],
                    {0, static_cast<std::uint64_t>(output)});
}

std::size_t StepRun::size_of(int output, std::size_t k) {
  ready();
  if (itemwise())
    return keeping_ == Keeping::passing ? expected_bytes(k) : state_.results.size_of(kept_keys_[k]);
  if (plan_.description->outputs[output].emission == Emission::one)
    return state_.results.size_of(whole_key_);
  if (lazy() && passed_bytes_ == 0) value(output, k);  // the first one tells how big they are
  if (lazy()) return passed_bytes_;
  return state_.results.size_of(whole_key_) / std::max<std::size_t>(1, count(output));
}

}  // namespace plumb
