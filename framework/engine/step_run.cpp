#include "plumb/engine/step_run.hpp"

#include "plumb/data/error.hpp"
#include "plumb/engine/item_context.hpp"
#include "plumb/engine/parallel.hpp"
#include "plumb/engine/step_key.hpp"

namespace plumb {
namespace {

/// Values [first, end) of an output, opened when asked for.
class RunCollection final : public Collection {
 public:
  RunCollection(Source source, std::size_t first, std::size_t end)
      : source_(std::move(source)), first_(first), end_(end) {}
  std::size_t size() const override { return end_ - first_; }
  AnyValue open(std::size_t k) const override { return source_.run->value(source_.output, first_ + k); }
  const Edges* edges() const override { return source_.run->edges().get(); }

 private:
  Source source_;
  std::size_t first_, end_;
};

}  // namespace

StepRun::StepRun(const PlannedStep& plan, const Step& step, const ParameterValues& values,
                 std::vector<std::vector<Source>> inputs, Keeping keeping, RunState state)
    : plan_(plan),
      step_(step),
      params_(step.parameters(values)),
      base_key_(step_key(*plan.description, values)),
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
  bool plain = true;  // only values of the pipeline are remembered
  for (const auto& output : outputs) plain &= output.emission == Emission::one;
  const bool memo = keeping_ == Keeping::remembered && plain;
  const Hash128 key = memo ? call_key(0) : base_key_;
  state_.books.observer().step_begins(plan_.path, 1);
  if (auto found = memo ? state_.memo.find(key) : std::nullopt) {
    for (AnyValue& value : *found) whole_.emplace_back().one = std::move(value);
    state_.books.add_item(plan_.path, true);
  } else {
    whole_ = call(0);
    state_.books.add_item(plan_.path, false);
    std::vector<AnyValue> values;
    for (const PortOutput& output : whole_) values.push_back(output.one);
    if (memo) state_.memo.store(key, std::move(values));
  }
  whole_keys_.resize(whole_.size());
  for (std::size_t o = 0; o < whole_.size(); ++o) {
    const Type& type = *outputs[o].type;
    if (outputs[o].emission == Emission::one) whole_keys_[o] = {type.hash(whole_[o].one.value.get())};
    for (const AnyValue& value : whole_[o].many) whole_keys_[o].push_back(type.hash(value.value.get()));
    for (const Hash128& lazy : whole_[o].lazy.keys) whole_keys_[o].push_back(joined_key(base_key_, lazy));
    asked_.push_back(std::make_unique<std::atomic<bool>[]>(whole_[o].lazy.keys.size()));
  }
  inputs_.clear();  // lets go of what came before
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
  const bool memo = keeping_ == Keeping::remembered;
  if (memo)
    if (auto found = state_.memo.find(key)) {
      state_.books.add_item(plan_.path, true);
      return std::move(*found);
    }
  std::vector<AnyValue> values;
  for (PortOutput& output : call(k)) values.push_back(std::move(output.one));
  state_.books.add_item(plan_.path, false);
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

std::size_t StepRun::first_frame(std::size_t k) const {
  for (std::size_t p = 0; p < inputs_.size(); ++p)
    if (!inputs_[p].empty() && plan_.description->inputs[p].type == &type_of<Range>())
      return inputs_[p].front().run->value(inputs_[p].front().output, k).as<Range>()->first;
  throw Error("has frames but no ranges");
}

std::size_t StepRun::end_frame(std::size_t k) const {
  for (std::size_t p = 0; p < inputs_.size(); ++p)
    if (!inputs_[p].empty() && plan_.description->inputs[p].type == &type_of<Range>())
      return inputs_[p].front().run->value(inputs_[p].front().output, k).as<Range>()->end;
  throw Error("has frames but no ranges");
}

/// Mirrors gather: what a call sees is what its key is made of.
void StepRun::hash_input(Hasher& hasher, std::size_t port, std::size_t k) {
  const InputDescription& input = plan_.description->inputs[port];
  const auto add = [&](const Hash128& h) { hasher.bytes(&h, sizeof h); };
  const auto add_number = [&](std::uint64_t n) { hasher.bytes(&n, sizeof n); };
  add_number(inputs_[port].size());
  if (inputs_[port].empty()) return;
  const Source& source = inputs_[port].front();
  switch (input.access) {
    case Access::item:
      add(source.run->key(source.output, input.type->grain == Grain::whole ? 0 : k));
      break;
    case Access::ends:
      add(source.run->key(source.output, edges_->list[k].i));
      add(source.run->key(source.output, edges_->list[k].j));
      break;
    case Access::each: {
      const bool own_frames = itemwise();
      const std::size_t first = own_frames ? first_frame(k) : 0;
      const std::size_t end = own_frames ? end_frame(k) : source.run->count(source.output);
      add_number(end - first);
      for (std::size_t n = first; n < end; ++n) add(source.run->key(source.output, n));
      if (source.run->edges()) add(content_hash(*source.run->edges()));
      break;
    }
    case Access::several:
      for (const Source& one : inputs_[port]) {
        hasher.text(one.label);
        add(one.run->key(one.output));
      }
      break;
    case Access::relative: {
      const auto poses = source.run->value(source.output).as<Poses>();
      add(content_hash(poses->relative(edges_->list[k].i, edges_->list[k].j)));
      break;
    }
    case Access::over_edges: break;
    case Access::this_edge: add(content_hash(edges_->list[k])); break;
  }
}

Hash128 StepRun::call_key(std::size_t k) {
  Hasher hasher;
  hasher.bytes(&base_key_, sizeof base_key_);
  for (std::size_t p = 0; p < inputs_.size(); ++p) hash_input(hasher, p, k);
  return hasher.hash();
}

std::vector<PortInput> StepRun::gather(std::size_t k) {
  std::vector<PortInput> ports(inputs_.size());
  for (std::size_t p = 0; p < ports.size(); ++p) {
    PortInput& port = ports[p];
    if (inputs_[p].empty()) continue;
    port.wired = true;
    const InputDescription& input = plan_.description->inputs[p];
    const Source& source = inputs_[p].front();
    switch (input.access) {
      case Access::item:
        port.one = source.run->value(source.output, input.type->grain == Grain::whole ? 0 : k);
        break;
      case Access::ends:
        port.one = source.run->value(source.output, edges_->list[k].i);
        port.other = source.run->value(source.output, edges_->list[k].j);
        break;
      case Access::each:
        port.each = itemwise() ? std::make_shared<RunCollection>(source, first_frame(k), end_frame(k))
                               : std::make_shared<RunCollection>(source, 0, source.run->count(source.output));
        break;
      case Access::several:
        for (const Source& one : inputs_[p]) port.several.emplace_back(one.label, one.run->value(one.output));
        break;
      case Access::relative:
        port.T_i_j = source.run->value(source.output).as<Poses>()->relative(edges_->list[k].i, edges_->list[k].j);
        break;
      case Access::over_edges: break;
      case Access::this_edge: port.edge = edges_->list[k]; break;
    }
  }
  return ports;
}

void StepRun::run_fold(std::vector<PortOutput>& outputs) {
  ItemContext context(state_.books, plan_.path, [this] { return base_key_.low; });
  const auto state = step_.begin({});
  std::size_t frames = 0;
  for (std::size_t p = 0; p < inputs_.size(); ++p)
    if (!inputs_[p].empty() && plan_.description->inputs[p].type->grain == Grain::frame)
      frames = inputs_[p].front().run->count(inputs_[p].front().output);
  for (std::size_t n = 0; n < frames; ++n) step_.fold(state.get(), params_.get(), gather(n), context);
  step_.finish(state.get(), params_.get(), outputs, context);
}

std::string StepRun::item_name(std::size_t k) const {
  switch (plan_.description->kind) {
    case StepKind::frame: return ", frame " + std::to_string(k);
    case StepKind::segment: return ", segment " + std::to_string(k);
    case StepKind::edge:
      return ", edge " + std::to_string(edges_->list[k].i) + "-" + std::to_string(edges_->list[k].j);
    default: return "";
  }
}

/// From what the call sees, by content: a copied file or another folder gives the same numbers. Collections are not looked at.
std::uint64_t StepRun::seed_of(const std::vector<PortInput>& inputs) const {
  Hasher hasher;
  hasher.bytes(&base_key_, sizeof base_key_);
  const auto add = [&](const AnyValue& value) {
    if (!value) return;
    const Hash128 content = value.type->hash(value.value.get());
    hasher.bytes(&content, sizeof content);
  };
  for (const PortInput& port : inputs) {
    add(port.one);
    add(port.other);
    for (const auto& [label, value] : port.several) add(value);
    const Hash128 rest = joined_key(content_hash(port.T_i_j), content_hash(port.edge));
    hasher.bytes(&rest, sizeof rest);
  }
  return hasher.hash().low;
}

std::vector<PortOutput> StepRun::call(std::size_t k) {
  std::vector<PortOutput> outputs(plan_.description->outputs.size());
  if (plan_.description->kind == StepKind::fold) {
    run_fold(outputs);
    return outputs;
  }
  const auto inputs = gather(k);  // outside the try: what an earlier step says of itself needs no second name
  const bool passing = itemwise() && keeping_ == Keeping::passing;
  ItemContext context(state_.books, plan_.path, [&] { return seed_of(inputs); }, !passing || first_asked(0, k));
  try {
    step_.run(params_.get(), inputs, outputs, context);
  } catch (const std::bad_alloc&) {
    throw Error("step '" + plan_.path + "' (" + plan_.description->name + ")" + item_name(k) +
                ": memory is used up; give smaller segments or a larger voxel");
  } catch (const NestedError&) {
    throw;
  } catch (const std::exception& e) {
    throw NestedError("step '" + plan_.path + "' (" + plan_.description->name + ")" + item_name(k) + ": " + e.what());
  }
  return outputs;
}

}  // namespace plumb
