/// The items of an item-wise step: which there are, reused, made, fetched again, dropped.
#include <algorithm>
#include <tuple>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/parallel.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {
namespace {

[[noreturn]] void refuse_counts(const PlannedStep& step, const std::string& one, std::size_t have,
                                const std::string& other, std::size_t wanted) {
  throw NestedError(
      "step '" + step.path + "' (" + step.description->name + "): " + one + " has " +
      counted(have, "items") + " where " + other + " has " + std::to_string(wanted) +
      "; wire what was cut alike, and if a cache was changed by hand, run with --refresh");
}

/// A key costs less than to measure its time.
constexpr std::size_t keys_at_a_time = 16;

/// An item, and an earlier one with the same key.
struct Repeated {
  std::size_t first, item;
};

/// Takes out of `calls` those whose key an earlier one has.
std::vector<Repeated> take_repeated(std::vector<std::size_t>& calls,
                                    const std::vector<Hash128>& keys) {
  std::sort(calls.begin(), calls.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(keys[a], a) < std::tie(keys[b], b);
  });
  std::vector<Repeated> repeated;
  std::vector<std::size_t> firsts;
  firsts.reserve(calls.size());
  for (const std::size_t k : calls)
    if (!firsts.empty() && keys[firsts.back()] == keys[k])
      repeated.push_back({firsts.back(), k});
    else
      firsts.push_back(k);
  std::sort(firsts.begin(), firsts.end());
  calls = std::move(firsts);
  return repeated;
}

}  // namespace

/// An item-wise step has as many items as the item-wise inputs that it is wired to, which must be
/// equally many.
void StepRun::find_items() {
  const auto& ports = plan_.description->inputs;
  std::string first;
  const auto take = [&](std::size_t items, const std::string& port) {
    if (!first.empty() && items != items_)
      refuse_counts(plan_, "'" + port + "'", items, "'" + first + "'", items_);
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
      refuse_counts(plan_, "'" + input.name + "'", *have,
                    "the graph of the " + plan_.description->items->name + "s", wanted);
  }
}

void StepRun::start_items() {
  if (keeping_ == Keeping::passing) return ready();
  join();
  state_.books.step_begins(plan_.path, state_.pass, items_);
  kept_keys_.resize(items_);
  pins_.resize(items_);
  std::vector<std::size_t> calls = find_keys();
  const std::vector<Repeated> repeated = take_repeated(calls, kept_keys_);
  reuse(calls);
  make(calls);
  for (const auto& [first, k] : repeated) {
    if (failures_.has(first)) {
      failures_.add(k, title(k) + ": as " + item_name(first));
      continue;
    }
    const Stopwatch watch(state_.books, plan_.path);
    pins_[k] = pins_[first];
    Stopwatch::item(item_name(k), state_.pass, true);
  }
  settle();
  if (!state_.results.store())
    inputs_.clear();  // nothing will have to be made again: lets go of what came before
}

/// Returns the items that have a key now; the others have failed, or are left out.
std::vector<std::size_t> StepRun::find_keys() {
  std::vector<char> known(items_, 0);
  parallel_for((items_ + keys_at_a_time - 1) / keys_at_a_time, [&](std::size_t b) {
    const Stopwatch watch(state_.books, plan_.path);
    const std::size_t end = std::min(items_, (b + 1) * keys_at_a_time);
    for (std::size_t k = b * keys_at_a_time; k < end && !stopped(); ++k) try {
        kept_keys_[k] = call_key(k);
        known[k] = 1;
      } catch (const NestedError& e) {
        failures_.add(k, e.what());
      }
  });
  std::vector<std::size_t> items;
  for (std::size_t k = 0; k < items_; ++k)
    if (known[k]) items.push_back(k);
  return items;
}

/// Takes out of `items` those that are there from an earlier pass or run.
void StepRun::reuse(std::vector<std::size_t>& items) {
  const bool store = state_.results.store() != nullptr;
  if (!store && keeping_ != Keeping::remembered) return;
  constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
  parallel_for(items.size(), [&](std::size_t n) {
    if (stopped()) return;
    const Stopwatch watch(state_.books, plan_.path);
    const std::size_t k = items[n];
    auto found = find(kept_keys_[k]);
    if (!found) return;
    if (store && state_.results.said().note(kept_keys_[k])) {
      say_again(*found);
      state_.books.from_earlier_run(plan_.path, 1);
    }
    if (!state_.results.in_store(kept_keys_[k])) pins_[k] = std::move(found);
    Stopwatch::item(item_name(k), state_.pass, true);
    items[n] = nowhere;
  });
  std::erase(items, nowhere);
}

/// What follows when calls failed: the run stops and names them, or, where `on_error: drop` says so
/// of items, their values are empty.
void StepRun::settle() {
  if (failures_.end_run())
    throw NestedError(
        failures_.sentence(plan_.path, [this](std::size_t k) { return item_name(k); }));
  for (const Failures::Failed& one : failures_.all()) {
    dropped_ = true;
    state_.books.warn(plan_.path,
                      one.sentence + "; " + item_name(one.item) + " is dropped (on_error: drop)");
    StoredResult empty;
    for (const auto& output : plan_.description->outputs)
      empty.outputs.push_back({AnyValue{output.type, output.type->code->empty()}});
    kept_keys_[one.item] =
        joined_key(kept_keys_[one.item], {0x64726f70, 0});  // not that of the true result
    kept(kept_keys_[one.item], std::move(empty), pins_[one.item]);
  }
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
  auto outputs = call(k, &said, true);
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
