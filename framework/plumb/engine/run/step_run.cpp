/// A step with its inputs joined: what is common to steps on items and on whole collections.
#include "plumb/engine/run/step_run.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/store/blob.hpp"

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

void StepRun::make_one(std::size_t k, const Hash128& expected, Reply& reply) {
  const Hash128 key = call_key(k);
  if (key != expected)
    throw MachineryError(title(k) +
                         ": what it works on is not the same here as in the run; did an input "
                         "change meanwhile, or has this worker other plugins?");
  StoredResult said;
  auto outputs = call(k, &said);
  for (const auto& [what, n] : said.counts) reply.counts.push_back({what, n});
  for (const PortOutput& output : outputs) reply.lazy.push_back(output.lazy.keys);
  const StoredResult result = result_of(outputs, std::move(said));
  if (lazy())
    reply.result = blob_of(key, result, plan_.description->name);
  else if (!state_.results.store()->put(key, result, plan_.description->name))
    throw MachineryError(title(k) + ": its result cannot be kept in the cache (" +
                         state_.results.store()->fault() +
                         "); make room, or name another with --cache-dir");
}

/// What a call said in another process, as if it had been made here, and that it was made.
void StepRun::book(const Reply& reply) {
  StoredResult said;
  for (const Counted& count : reply.counts) {
    state_.books.count(plan_.path, count.what, count.n);
    said.counts.emplace_back(count.what, count.n);
  }
  const std::string own_sentences = plan_.path + ": ";
  for (const std::string& sentence : reply.warnings) {
    state_.books.say(sentence.substr(0, sentence.find(':')), sentence);
    if (sentence.starts_with(own_sentences))
      said.warnings.push_back(sentence.substr(own_sentences.size()));
  }
  note(said);
  double own = 0;
  for (const Spent& spent : reply.spent)
    if (spent.path == plan_.path)
      own += spent.cpu_seconds;
    else
      state_.books.add_time(spent.path, spent.cpu_seconds);
  if (reply.process) state_.books.memory().add_process(static_cast<int>(reply.process));
  const auto end = Bookkeeping::Clock::now();
  const auto seconds = std::chrono::duration_cast<Bookkeeping::Clock::duration>(
      std::chrono::duration<double>(reply.seconds));
  if (!reply.fault.empty()) return state_.books.add_time(plan_.path, own);
  state_.books.item({plan_.path, item_name(reply.item), state_.pass, false, end - seconds, end, own,
                     static_cast<int>(reply.process), 0});
}

void StepRun::book_passed(const PassedCounts& passed) {
  if (passed.output >= asked_.size() || passed.item >= count(static_cast<int>(passed.output)) ||
      !first_asked(passed.output, passed.item))
    return;
  for (const Counted& count : passed.counts) state_.books.count(plan_.path, count.what, count.n);
}

bool StepRun::adopt_result(std::size_t k) {
  const Hash128& key = key_of_call(k);
  Results& results = state_.results;
  if (!results.store()->contains(key)) return false;
  results.made_elsewhere(key, plan_.description->name);
  const auto found = find(key);
  if (found) say_again(*found);
  return found != nullptr;
}

void StepRun::require_in_store() const {
  const Results& results = state_.results;
  bool all = true;
  if (itemwise())
    for (const Hash128& key : kept_keys_) all &= results.in_store(key);
  else
    all = results.in_store(whole_key_);
  if (!all)
    throw Error(
        "step '" + plan_.path +
        "': not all of its results are in the cache, from which workers take them" +
        (results.store()->fault().empty()
             ? std::string("; run again")
             : " (" + results.store()->fault() + "); make room, or name another with --cache-dir"));
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
  try {
    AnyValue value = lazy_[output].open(k, context);
    require_sound(value, static_cast<std::size_t>(output));
    passed_bytes_ = std::max(passed_bytes_.load(), value.type->code->bytes(value.value.get()));
    if (first) note(said);
    if (first && state_.passed) state_.passed(*this, output, k, said);
    return value;
  } catch (const std::exception& e) {
    throw NestedError("step '" + plan_.path + "' (" + plan_.description->name +
                      "): " + sentence_of(e));
  }
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
