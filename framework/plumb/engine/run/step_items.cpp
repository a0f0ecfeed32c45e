/// The items of an item-wise step: which there are, reused, made here or
/// elsewhere, fetched again, dropped.
#include <algorithm>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {
namespace {

/// So many items of a step may fail before the rest is left out: then it is not the items.
constexpr std::size_t most_failures = 16;

}  // namespace

/// An item-wise step has as many items as the item-wise inputs that it is wired to, which must be
/// equally many.
void StepRun::find_items() {
  const auto& ports = plan_.description->inputs;
  std::string first;
  const auto take = [&](std::size_t items, const std::string& port) {
    if (!first.empty() && items != items_)
      refuse_counts("'" + port + "'", items, "'" + first + "'", items_);
    items_ = items, first = port;
  };
  for (std::size_t p = 0; p < ports.size(); ++p) {
    if (inputs_[p].empty()) continue;
    const Source& source = inputs_[p].front();
    if (plan_.description->lists_items(ports[p])) {
      list_source_ = source;
      list_ = source.run->value(source.output);
      take(list_.type->code->list->size(list_.value.get()), ports[p].name);
    } else if (ports[p].access == Access::item && source.run->per_item(source.output)) {
      take(source.run->count(source.output), ports[p].name);
      if (source.run->list()) list_source_ = source.run->list_source(), list_ = source.run->list();
    }
  }
}

/// What an item joins (an edge's segments) is taken from the step's inputs by its place.
void StepRun::require_ends() {
  if (!list_) return;
  const std::size_t wanted = list_.type->code->list->ends_count(list_.value.get());
  for (std::size_t k = 0; k < items_; ++k)
    if (const ItemPlace place = place_of(k); place.i >= wanted || place.j >= wanted)
      throw NestedError(title(k) + ": joins what there is not; there are " +
                        std::to_string(wanted) + " " + plan_.description->items->ends + "s");
  for (std::size_t p = 0; p < inputs_.size(); ++p) {
    if (inputs_[p].empty()) continue;
    const InputDescription& input = plan_.description->inputs[p];
    const Source& source = inputs_[p].front();
    std::optional<std::size_t> have;
    if (input.access == Access::ends) have = source.run->count(source.output);
    if (input.access == Access::part && !plan_.description->lists_items(input))
      have = step_.ends_count(p, source.run->value(source.output).value.get());
    if (have && *have != wanted)
      refuse_counts("'" + input.name + "'", *have,
                    "the graph of the " + plan_.description->items->name + "s", wanted);
  }
}

void StepRun::refuse_counts(const std::string& one, std::size_t have, const std::string& other,
                            std::size_t wanted) const {
  throw NestedError(
      "step '" + plan_.path + "' (" + plan_.description->name + "): " + one + " has " +
      counted(have, "items") + " where " + other + " has " + std::to_string(wanted) +
      "; wire what was cut alike, and if a cache was changed by hand, run with --refresh");
}

void StepRun::adopt_items(std::vector<Hash128> keys, Source list) {
  kept_keys_ = std::move(keys);
  items_ = kept_keys_.size();
  pins_.resize(items_);
  if (list.run) list_ = list.run->value(list.output);
  list_source_ = std::move(list);
}

void StepRun::start_items() {
  if (keeping_ == Keeping::passing) return ready();
  join();
  state_.books.step_begins(plan_.path, state_.pass, items_);
  kept_keys_.resize(items_);
  pins_.resize(items_);
  if (state_.executor)
    make_items_elsewhere();
  else
    make_items_here();
  if (!state_.results.store())
    inputs_.clear();  // nothing will have to be made again: lets go of what came before
}

/// Whether item k is there from an earlier pass or run.
bool StepRun::reuse(std::size_t k) {
  const Hash128& key = kept_keys_[k];
  const bool store = state_.results.store() != nullptr;
  if (!store && keeping_ != Keeping::remembered) return false;
  const bool here = store && state_.results.in_store(key);
  auto found = find(key);
  if (!found) return false;
  if (store && !here) {
    say_again(*found);
    state_.books.from_earlier_run(plan_.path, 1);
  }
  if (!state_.results.in_store(key)) pins_[k] = std::move(found);
  Stopwatch::item(item_name(k), state_.pass, true);
  return true;
}

void StepRun::make_item(std::size_t k) {
  const Admission::Ticket ticket(state_.admission,
                                 state_.admission.bounded() ? expected_bytes(k) : 0);
  StoredResult said;
  auto outputs = call(k, &said);
  note(said);
  kept(kept_keys_[k], result_of(outputs, std::move(said)), pins_[k]);
  Stopwatch::item(item_name(k), state_.pass, false);
}

void StepRun::make_items_here() {
  std::mutex mutex;
  std::vector<Failed> failed;
  parallel_for(items_, [&](std::size_t k) {
    const Stopwatch watch(state_.books, plan_.path);
    {
      const std::lock_guard lock(mutex);
      if (failed.size() >= most_failures && plan_.on_error == OnError::stop) return;
    }
    try {
      kept_keys_[k] = call_key(k);
      if (!reuse(k)) make_item(k);
    } catch (const NestedError& e) {
      const std::lock_guard lock(mutex);
      failed.push_back({k, e.what()});
    }
  });
  settle(std::move(failed));
}

void StepRun::make_items_elsewhere() {
  std::vector<char> missing(items_, 0);
  parallel_for(items_, [&](std::size_t k) {
    const Stopwatch watch(state_.books, plan_.path);
    kept_keys_[k] = call_key(k);
    missing[k] = !reuse(k);
  });
  std::vector<std::size_t> calls;
  std::map<Hash128, std::size_t> first;  // items with the same key are made once
  for (std::size_t k = 0; k < items_; ++k)
    if (missing[k] && first.try_emplace(kept_keys_[k], k).second) calls.push_back(k);
  std::vector<Failed> failed;
  if (!calls.empty())
    state_.executor->make(*this, calls, [&](const Reply& reply) {
      book(reply);
      const std::size_t k = reply.item;
      if (reply.machinery) throw NestedError(reply.fault);
      if (!reply.fault.empty())
        failed.push_back({k, reply.fault});
      else if (!has_result(k))
        throw NestedError(
            title(k) +
            ": its result did not come into the cache; is the folder the same for all processes?");
      else
        state_.results.made_elsewhere(kept_keys_[k], plan_.description->name);
      if (failed.size() >= most_failures && plan_.on_error == OnError::stop) settle(failed);
    });
  const auto made = failed;
  for (const Failed& one : made)
    for (std::size_t k = 0; k < items_; ++k)
      if (missing[k] && k != one.item && kept_keys_[k] == kept_keys_[one.item])
        failed.push_back({k, title(k) + ": as " + item_name(one.item)});
  settle(std::move(failed));
}

/// What follows when items failed: the run stops and names them, or, where `on_error: drop` says
/// so, their values are empty.
void StepRun::settle(std::vector<Failed> failed) {
  if (failed.empty()) return;
  std::sort(failed.begin(), failed.end(),
            [](const Failed& a, const Failed& b) { return a.item < b.item; });
  const bool all = failed.size() >= most_failures;
  if (plan_.on_error == OnError::drop) {
    dropped_ = true;
    for (const Failed& one : failed) {
      state_.books.warn(plan_.path,
                        one.sentence + "; " + item_name(one.item) + " is dropped (on_error: drop)");
      StoredResult empty;
      for (const auto& output : plan_.description->outputs)
        empty.outputs.push_back({AnyValue{output.type, output.type->code->empty()}});
      kept_keys_[one.item] =
          joined_key(kept_keys_[one.item], {0x64726f70, 0});  // not that of the true result
      kept(kept_keys_[one.item], std::move(empty), pins_[one.item]);
    }
    return;
  }
  std::string sentence = failed.front().sentence;
  if (failed.size() > 1) {
    sentence += "; " + std::to_string(failed.size() - 1) + (all ? " or more" : "") +
                " further items of step '" + plan_.path + "' failed:";
    for (std::size_t f = 1; f < failed.size() && f < 6; ++f)
      sentence += (f > 1 ? ", " : " ") + item_name(failed[f].item);
    if (failed.size() > 6) sentence += ", ...";
  }
  throw NestedError(sentence);
}

/// A result that left memory comes back from the store; what is gone from there (pruned, damaged)
/// is made again.
SharedResult StepRun::fetch(std::size_t k) {
  if (pins_[k]) return pins_[k];
  if (auto found = find(kept_keys_[k])) return found;
  if (inputs_.empty() && !plan_.description->inputs.empty())
    throw NestedError(title(k) + ": its result is gone from the cache; run again, it is made anew");
  const Stopwatch watch(state_.books, plan_.path);
  StoredResult said;
  auto outputs = call(k, &said);
  SharedResult pin, made = kept(kept_keys_[k], result_of(outputs, std::move(said)), pin);
  Stopwatch::item(item_name(k), state_.pass, false);
  return made;
}

/// What passes through is made for each that asks, but its counts are booked once.
std::vector<AnyValue> StepRun::pass(std::size_t k) {
  const Stopwatch watch(state_.books, plan_.path);
  StoredResult said;
  std::vector<AnyValue> values;
  for (PortOutput& output : call(k, &said)) values.push_back(std::move(output.one));
  Stopwatch::item(item_name(k), state_.pass, false);
  return values;
}

}  // namespace plumb
