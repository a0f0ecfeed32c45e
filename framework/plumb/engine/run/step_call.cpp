/// What one call of a step sees: the inputs that it gathers, the key that they make, the call
/// itself.
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/item_context.hpp"
#include "plumb/engine/run/running_call.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {
namespace {

/// Values [first, end) of an output, opened when asked for.
class RunCollection final : public Collection {
 public:
  RunCollection(Source source, std::size_t first, std::size_t end)
      : source_(std::move(source)), first_(first), end_(end) {}
  std::size_t size() const override { return end_ - first_; }
  AnyValue open(std::size_t k) const override {
    return source_.run->value(source_.output, first_ + k);
  }
  AnyValue list() const override { return source_.run->list(); }

 private:
  Source source_;
  std::size_t first_, end_;
};

/// From what the call sees, by content: a copied file or another folder gives the same numbers.
/// Collections are not looked at.
/// Of the inputs' content alone, so that neither a name nor a version nor another build changes
/// what a step draws.
std::uint64_t seed_of(const std::vector<PortInput>& inputs) {
  Hasher hasher;
  const auto add = [&](const AnyValue& value) {
    if (!value) return;
    const Hash128 content = value.hash();
    hasher.bytes(&content, sizeof content);
  };
  for (const PortInput& port : inputs) {
    add(port.one);
    add(port.other);
    for (const auto& [label, value] : port.several) add(value);
    if (port.part.value) hasher.bytes(&port.part.hash, sizeof port.part.hash);
  }
  return hasher.hash().low;
}

}  // namespace

/// The place of item k, and of what it joins.
ItemPlace StepRun::place_of(std::size_t k) {
  const AnyValue& of = own_list();
  if (!of) return {k, 0, 0};
  const auto [i, j] = of.type->code->list->ends(of.value.get(), k);
  return {k, i, j};
}

/// Those of `parts` that item k is made of.
std::pair<std::size_t, std::size_t> StepRun::parts_of(std::size_t k, const Source& parts) {
  const ItemKind& kind = *plan_.description->items;
  for (std::size_t p = 0; p < inputs_.size(); ++p) {
    const Type& type = *plan_.description->inputs[p].type;
    if (inputs_[p].empty() || type.name != kind.ranges) continue;
    const AnyValue value = inputs_[p].front().run->value(inputs_[p].front().output, k);
    const auto [first, end] = type.code->range(value.value.get());
    const std::size_t there = parts.run->count(parts.output);
    if (first > end || end > there)
      throw NestedError(title(k) + ": has " + kind.parts + "s up to " + std::to_string(end) +
                        " and there are " + std::to_string(there) + "; wire ranges that these " +
                        kind.parts +
                        "s were cut into, and if a cache was changed by hand, run with --refresh");
    return {first, end};
  }
  throw Error("has " + kind.parts + "s but no ranges");
}

/// Mirrors gather: what a call sees is what its key is made of.
void StepRun::hash_input(Hasher& hasher, std::size_t port, std::size_t k) {
  const InputDescription& input = plan_.description->inputs[port];
  const auto add = [&](const Hash128& h) { hasher.bytes(&h, sizeof h); };
  const auto add_number = [&](std::uint64_t n) { hasher.bytes(&n, sizeof n); };
  add_number(inputs_[port].size());
  if (inputs_[port].empty()) return;
  const Source& source = inputs_[port].front();
  const auto range = [&] {
    return itemwise() ? parts_of(k, source)
                      : std::pair(std::size_t{0}, source.run->count(source.output));
  };
  switch (input.access) {
    case Access::item:
      add(source.run->key(source.output, source.run->per_item(source.output) ? k : 0));
      break;
    case Access::ends:
      add(source.run->key(source.output, place_of(k).i));
      add(source.run->key(source.output, place_of(k).j));
      break;
    case Access::each: {
      const auto [first, end] = range();
      add_number(end - first);
      for (std::size_t n = first; n < end; ++n) add(source.run->key(source.output, n));
      if (source.run->list()) add(source.run->list().hash());
      break;
    }
    case Access::several:
      for (const Source& one : inputs_[port]) {
        hasher.text(one.label);
        add(one.run->key(one.output));
      }
      break;
    case Access::part: {
      const SeenPart part = part_of(port, k);
      if (part.value) add(part.hash);
      break;
    }
  }
}

/// What item k is seen of the value that an input is wired to.
SeenPart StepRun::part_of(std::size_t port, std::size_t k) {
  const Source& source = inputs_[port].front();
  const AnyValue whole = plan_.description->lists_items(plan_.description->inputs[port])
                             ? own_list()
                             : source.run->value(source.output);
  return step_.part(port, whole.value.get(), place_of(k));
}

Hash128 StepRun::call_key(std::size_t k) {
  Hasher hasher;
  hasher.bytes(&base_key_, sizeof base_key_);
  hasher.bytes(&files_key_, sizeof files_key_);
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
        port.one = source.run->value(source.output, source.run->per_item(source.output) ? k : 0);
        break;
      case Access::ends:
        port.one = source.run->value(source.output, place_of(k).i);
        port.other = source.run->value(source.output, place_of(k).j);
        break;
      case Access::each: {
        const auto [first, end] = itemwise()
                                      ? parts_of(k, source)
                                      : std::pair(std::size_t{0}, source.run->count(source.output));
        port.each = std::make_shared<RunCollection>(source, first, end);
        break;
      }
      case Access::several:
        for (const Source& one : inputs_[p])
          port.several.emplace_back(one.label, one.run->value(one.output));
        break;
      case Access::part:
        port.part = part_of(p, k);
        break;
    }
  }
  return ports;
}

/// Memory that a call may need [bytes], about: its inputs, and twice as much for what is made of
/// them. Frames are as big as the biggest seen.
std::size_t StepRun::expected_bytes(std::size_t k) {
  std::size_t bytes = 0;
  for (std::size_t p = 0; p < inputs_.size(); ++p) {
    if (inputs_[p].empty()) continue;
    const InputDescription& input = plan_.description->inputs[p];
    const Source& source = inputs_[p].front();
    if (input.access == Access::item && source.run->per_item(source.output))
      bytes += source.run->size_of(source.output, k);
    if (input.access == Access::ends)
      bytes += source.run->size_of(source.output, place_of(k).i) +
               source.run->size_of(source.output, place_of(k).j);
    if (input.access == Access::each && itemwise()) {
      const auto [first, end] = parts_of(k, source);
      for (std::size_t n = first; n < end; ++n) bytes += source.run->size_of(source.output, n);
    }
  }
  return keeping_ == Keeping::passing ? bytes : 3 * bytes;
}

/// What no step may give is refused here, so that the step that made it is named.
void StepRun::require_sound(const AnyValue& value, std::size_t output) const {
  if (!value) return;
  if (const char* fault = value.type->code->fault(value.value.get()); *fault)
    throw Error("its output '" + plan_.description->outputs[output].name + "' holds " + fault +
                "; the step must not give that, whatever its input");
}

void StepRun::check_outputs(const std::vector<PortOutput>& outputs, std::size_t k) {
  try {
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      require_sound(outputs[o].one, o);
      for (const AnyValue& value : outputs[o].many) require_sound(value, o);
    }
  } catch (const Error& e) {
    throw NestedError(title(k) + ": " + e.what());
  }
}

void StepRun::run_call(const std::vector<PortInput>& inputs, std::vector<PortOutput>& outputs,
                       Context& context, std::size_t k) {
  const RunningCall now(*this, k);
  try {
    step_.run(params_.get(), inputs, outputs, context);
  } catch (const NestedError&) {
    throw;
  } catch (const std::exception& e) {
    throw NestedError(title(k) + ": " + sentence_of(e));
  } catch (...) {
    throw NestedError(
        title(k) + ": threw something that is no std::exception; the step must throw plumb::Error");
  }
  check_outputs(outputs, k);
}

/// With `again` the call was made before in this run or an earlier one, and its counts are said.
std::vector<PortOutput> StepRun::call(std::size_t k, StoredResult* said, bool again) {
  std::vector<PortOutput> outputs(plan_.description->outputs.size());
  // What an earlier step says of itself needs no second name.
  const auto inputs = gather(k);
  const bool passing = itemwise() && keeping_ == Keeping::passing,
             first = passing && first_asked(0, k);
  // In a worker nothing is booked but what is warned: counts go home with the reply.
  ItemContext context(
      state_.books, plan_.path, [&] { return seed_of(inputs); },
      !state_.passed && (passing ? first : !again), said);
  try {
    run_call(inputs, outputs, context, k);
  } catch (...) {
    if (first) note_first(*said);
    throw;
  }
  if (first) note_first(*said);
  if (first && state_.passed) state_.passed(*this, 0, k, *said);
  return outputs;
}

}  // namespace plumb
