/// A step on whole collections: reused, made here or elsewhere, and its values named.
#include <algorithm>

#include "plumb/data/counted.hpp"
#include "plumb/data/document.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/step_run.hpp"
#include "plumb/store/blob.hpp"

namespace plumb {
namespace {

/// Results of whole steps stay in memory when they are small, and when they are files, which the
/// run holds until its end anyway.
bool stays_in_memory(const StoredResult& result) {
  constexpr std::size_t small = std::size_t{1} << 20;
  for (const auto& values : result.outputs)
    for (const AnyValue& value : values)
      if (value.type == &type_of<Document>()) return true;
  return memory_of(result) <= small;
}

}  // namespace

void StepRun::start_whole() {
  const Stopwatch watch(state_.books, plan_.path);
  state_.books.step_begins(plan_.path, state_.pass, 1);
  whole_key_ = call_key(0);
  if (find_whole()) {
    Stopwatch::item("", state_.pass, true);
  } else {
    make({0});
    settle();
  }
  name_values();
  if (!state_.results.store()) inputs_.clear();
}

/// Only what is plain is looked up: what is lazy must be made, for its values are made when asked
/// for. Without a store only values of the whole pipeline are remembered.
bool StepRun::find_whole() {
  bool single = true;
  for (const auto& output : plan_.description->outputs) single &= output.emission == Emission::one;
  const bool store = state_.results.store() != nullptr;
  if (lazy() || !(store || (keeping_ == Keeping::remembered && single))) return false;
  auto found = find(whole_key_);
  if (!found) return false;
  if (store && state_.results.said().note(whole_key_)) {
    say_again(*found);
    state_.books.from_earlier_run(plan_.path, 1);
  }
  if (!state_.results.in_store(whole_key_) || stays_in_memory(*found))
    whole_pin_ = std::move(found);
  return true;
}

void StepRun::take_whole(std::vector<PortOutput> outputs, StoredResult said) {
  for (PortOutput& output : outputs) lazy_.push_back(std::move(output.lazy));
  StoredResult result = result_of(outputs, std::move(said));
  if (lazy()) {
    whole_pin_ = std::make_shared<const StoredResult>(std::move(result));
    return;
  }
  const bool stays = stays_in_memory(result);
  SharedResult made = kept(whole_key_, std::move(result), whole_pin_);
  if (stays) whole_pin_ = std::move(made);
}

/// Whether it is there.
bool StepRun::take_whole_from(const Reply& reply) {
  if (!lazy()) {
    auto found = find(whole_key_);
    if (found && stays_in_memory(*found)) whole_pin_ = found;
    return found != nullptr;
  }
  lazy_.resize(plan_.description->outputs.size());
  for (std::size_t o = 0; o < std::min(reply.lazy.size(), lazy_.size()); ++o) {
    lazy_[o].keys = reply.lazy[o];
    lazy_[o].open = [](std::size_t, Context&) -> AnyValue {
      throw Error(
          "its values are made by workers alone; a result was lost from the cache meanwhile: run "
          "again, it is made anew");
    };
  }
  auto result = read_blob(whole_key_, reply.result);
  if (!result || !misfit_of(*result).empty())
    throw NestedError(title(0) + ": its worker gave a result that cannot be read; run again");
  whole_pin_ = std::make_shared<const StoredResult>(std::move(*result));
  return true;
}

/// Gives every value its key, by content; what is lazy by what its step says of it.
void StepRun::name_values() {
  const auto result = whole();
  const auto& outputs = plan_.description->outputs;
  whole_keys_.resize(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    for (const AnyValue& value : result->outputs[o]) whole_keys_[o].push_back(value.hash());
    if (o < lazy_.size())
      for (const Hash128& key : lazy_[o].keys) whole_keys_[o].push_back(joined_key(base_key_, key));
    check_items(o);
    asked_.push_back(std::make_unique<std::atomic<bool>[]>(whole_keys_[o].size()));
  }
}

/// Many values that belong to the items of an input must be as many.
void StepRun::check_items(std::size_t output) {
  const OutputDescription& port = plan_.description->outputs[output];
  const Source* source = source_over(output);
  if (!source) return;
  const std::size_t items = source->run->count(source->output), made = whole_keys_[output].size();
  if (made != items)
    throw Error("step '" + plan_.path + "' (" + plan_.description->name + "): its output '" +
                port.name + "' has " + counted(made, "values") + " where its input '" + port.over +
                "' has " + std::to_string(items) + "; the step must give one for each");
  if (source->run->list()) list_source_ = source->run->list_source(), list_ = source->run->list();
}

/// The input to whose items the values of an output belong; null when they are items of their own.
const Source* StepRun::source_over(std::size_t output) const {
  const OutputDescription& port = plan_.description->outputs[output];
  if (port.over.empty()) return nullptr;
  for (std::size_t p = 0; p < inputs_.size(); ++p)
    if (plan_.description->inputs[p].name == port.over && !inputs_[p].empty())
      return &inputs_[p].front();
  return nullptr;
}

/// The result, back from the store if it left memory; made again if it is gone from there.
SharedResult StepRun::whole() {
  if (whole_pin_) return whole_pin_;
  if (auto found = find(whole_key_)) return found;
  if (inputs_.empty() && !plan_.description->inputs.empty())
    throw NestedError(title(0) + ": its result is gone from the cache; run again, it is made anew");
  StoredResult said;
  auto outputs = call(0, &said, true);
  SharedResult pin;
  return kept(whole_key_, result_of(outputs, std::move(said)), pin);
}

}  // namespace plumb
