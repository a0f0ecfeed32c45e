/// What a step makes in one pass, how long it is kept, and how it is fetched.
#include "plumb/engine/step_run.hpp"

#include "plumb/data/error.hpp"
#include "plumb/engine/item_context.hpp"
#include "plumb/engine/parallel.hpp"
#include "plumb/engine/step_key.hpp"

namespace plumb {

StepRun::StepRun(const PlannedStep& plan, const Step& step, const ParameterValues& values,
                 std::vector<std::vector<Source>> inputs, Keeping keeping, RunState state)
    : plan_(plan),
      step_(step),
      params_(step.parameters(values)),
      base_key_(step_key(*plan.description, values)),
      files_key_(files_key(*plan.description, values)),
      inputs_(std::move(inputs)),
      keeping_(keeping),
      state_(state) {}

bool StepRun::itemwise() const {
  const StepKind kind = plan_.description->kind;
  return kind != StepKind::whole && kind != StepKind::fold;
}

/// An item-wise step has as many items as the item-wise inputs that it is wired to.
void StepRun::find_items() {
  const auto& ports = plan_.description->inputs;
  for (std::size_t p = 0; p < ports.size(); ++p) {
    if (inputs_[p].empty()) continue;
    const Source& source = inputs_[p].front();
    const Access access = ports[p].access;
    if (access == Access::over_edges || access == Access::this_edge) {
      edges_ = source.run->value(source.output).as<Edges>();
      items_ = edges_->size();
    } else if (access == Access::item && ports[p].type->grain != Grain::whole) {
      items_ = source.run->count(source.output);
      if (ports[p].type->grain == Grain::edge) edges_ = source.run->edges();
    }
  }
}

void StepRun::start_whole() {
  const Stopwatch watch(state_.books, plan_.path);
  const auto& outputs = plan_.description->outputs;
  bool single = true, plain = true;  // only values of the pipeline are remembered, and what is lazy is never stored
  for (const auto& output : outputs) single &= output.emission == Emission::one, plain &= output.emission != Emission::lazy;
  const bool memo = keeping_ == Keeping::remembered && single, store = state_.store && plain;
  const Hash128 key = memo || store ? call_key(0) : base_key_;
  state_.books.observer().step_begins(plan_.path, 1);
  if (auto found = memo ? state_.memo.find(key) : std::nullopt) {
    for (AnyValue& value : *found) whole_.emplace_back().one = std::move(value);
    state_.books.add_item(plan_.path, true);
  } else {
    if (auto kept = store ? stored(key) : std::nullopt) {
      whole_.resize(kept->outputs.size());
      for (std::size_t o = 0; o < whole_.size(); ++o)
        if (outputs[o].emission == Emission::one) whole_[o].one = std::move(kept->outputs[o].at(0));
        else whole_[o].many = std::move(kept->outputs[o]);
      state_.books.add_item(plan_.path, true);
    } else {
      StoredResult result;
      whole_ = call(0, store ? &result : nullptr);
      state_.books.add_item(plan_.path, false);
      if (store) {
        for (std::size_t o = 0; o < whole_.size(); ++o)
          result.outputs.push_back(outputs[o].emission == Emission::one ? std::vector<AnyValue>{whole_[o].one} : whole_[o].many);
        state_.store->put(key, result);
      }
    }
    std::vector<AnyValue> values;
    for (const PortOutput& output : whole_) values.push_back(output.one);
    if (memo) state_.memo.store(key, std::move(values));
  }
  whole_keys_.resize(whole_.size());
  for (std::size_t o = 0; o < whole_.size(); ++o) {
    check_items(o);
    const Type& type = *outputs[o].type;
    if (outputs[o].emission == Emission::one) whole_keys_[o] = {type.hash(whole_[o].one.value.get())};
    for (const AnyValue& value : whole_[o].many) whole_keys_[o].push_back(type.hash(value.value.get()));
    for (const Hash128& lazy : whole_[o].lazy.keys) whole_keys_[o].push_back(joined_key(base_key_, lazy));
    asked_.push_back(std::make_unique<std::atomic<bool>[]>(whole_[o].lazy.keys.size()));
  }
  inputs_.clear();  // lets go of what came before
}

/// Many values that belong to the items of an input must be as many.
void StepRun::check_items(std::size_t output) {
  const OutputDescription& port = plan_.description->outputs[output];
  if (port.over.empty()) return;
  for (std::size_t p = 0; p < inputs_.size(); ++p) {
    if (plan_.description->inputs[p].name != port.over || inputs_[p].empty()) continue;
    const Source& source = inputs_[p].front();
    const std::size_t items = source.run->count(source.output);
    const std::size_t made = whole_[output].many.size() + whole_[output].lazy.keys.size();
    if (made != items)
      throw Error("step '" + plan_.path + "' (" + plan_.description->name + "): its output '" + port.name + "' has " +
                  std::to_string(made) + " values where its input '" + port.over + "' has " + std::to_string(items) +
                  "; the step must give one for each");
    if (port.type->grain == Grain::edge) edges_ = source.run->edges();
  }
}

void StepRun::start() {
  if (!itemwise()) return start_whole();
  find_items();
  if (keeping_ == Keeping::passing) {
    asked_.push_back(std::make_unique<std::atomic<bool>[]>(items_));
    return;
  }
  state_.books.observer().step_begins(plan_.path, items_);
  kept_.resize(items_);
  kept_keys_.resize(items_);
  parallel_for(items_, [this](std::size_t k) {
    const Stopwatch watch(state_.books, plan_.path);
    kept_keys_[k] = call_key(k);
    kept_[k] = make(k, kept_keys_[k]);
    state_.books.observer().item_done(plan_.path);
  });
  inputs_.clear();
}

std::size_t StepRun::count(int output) const {
  if (itemwise()) return items_;
  return whole_keys_[output].size();
}

/// What passes through is made for each that asks, but its counts are booked once.
bool StepRun::first_asked(int output, std::size_t k) { return !asked_[output][k].exchange(true); }

std::vector<AnyValue> StepRun::make(std::size_t k, const Hash128& key) {
  const bool memo = keeping_ == Keeping::remembered, store = state_.store && keeping_ != Keeping::passing;
  if (memo)
    if (auto found = state_.memo.find(key)) {
      state_.books.add_item(plan_.path, true);
      return std::move(*found);
    }
  std::vector<AnyValue> values;
  if (auto kept = store ? stored(key) : std::nullopt) {
    for (auto& output : kept->outputs) values.push_back(std::move(output.at(0)));
    state_.books.add_item(plan_.path, true);
  } else {
    StoredResult result;
    for (PortOutput& output : call(k, store ? &result : nullptr)) values.push_back(std::move(output.one));
    state_.books.add_item(plan_.path, false);
    if (store) {
      for (const AnyValue& value : values) result.outputs.push_back({value});
      state_.store->put(key, result);
    }
  }
  if (memo) state_.memo.store(key, values);
  return values;
}

AnyValue StepRun::value(int output, std::size_t k) {
  if (itemwise()) {
    if (keeping_ != Keeping::passing) return kept_[k][output];
    const Stopwatch watch(state_.books, plan_.path);
    return make(k, call_key(k))[output];
  }
  PortOutput& made = whole_[output];
  switch (plan_.description->outputs[output].emission) {
    case Emission::one: return made.one;
    case Emission::many: return made.many[k];
    case Emission::lazy: break;
  }
  const Stopwatch watch(state_.books, plan_.path);
  ItemContext context(state_.books, plan_.path, [&] { return whole_keys_[output][k].low; }, first_asked(output, k));
  try {
    return made.lazy.open(k, context);
  } catch (const std::exception& e) {
    throw NestedError("step '" + plan_.path + "' (" + plan_.description->name + "): " + e.what());
  }
}

Hash128 StepRun::key(int output, std::size_t k) {
  if (!itemwise()) return whole_keys_[output][k];
  return joined_key(keeping_ == Keeping::passing ? call_key(k) : kept_keys_[k], {0, static_cast<std::uint64_t>(output)});
}

}  // namespace plumb
