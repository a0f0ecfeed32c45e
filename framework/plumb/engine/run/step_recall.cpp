/// What a step gave in an earlier run, known without opening a result.
///
/// The recall key of a step is made of its own parameters and of the recall keys of the steps that
/// it is wired to, and so of all that its results depend on, but of no value. Under it the index of
/// the store keeps what others may ask of the step short of its values (store/index.hpp). A run in
/// which nothing changed recalls every step but the sources, and opens the documents alone. A value
/// that somebody does ask for comes from the store as ever, and is made again if it is gone.
#include <algorithm>

#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/step_run.hpp"

namespace plumb {
namespace {

/// Values with numbers are kept in the index up to this many bytes each.
constexpr std::size_t most_bytes_of_numbers = std::size_t{256} << 10;

}  // namespace

/// Of a source, whose values must be looked at anew in each run, and of a step that dropped items,
/// of their keys.
Hash128 StepRun::find_recall_key() const {
  Hasher hasher;
  hasher.text("recall 2");  // 1: kept and passing in one row
  hasher.bytes(&base_key_, sizeof base_key_);
  hasher.bytes(&files_key_, sizeof files_key_);
  const auto add = [&](const Hash128& key) { hasher.bytes(&key, sizeof key); };
  for (const auto& sources : inputs_) {
    const std::size_t n = sources.size();
    hasher.bytes(&n, sizeof n);
    for (const Source& source : sources) {
      hasher.text(source.label);
      hasher.bytes(&source.output, sizeof source.output);
      add(source.run->recall_key_);
    }
  }
  if (lazy())
    for (const auto& keys : whole_keys_)
      for (const Hash128& key : keys) add(key);
  if (dropped_)
    for (const Hash128& key : kept_keys_) add(key);
  return hasher.hash();
}

/// Where the index has what is remembered. Of what is made when it is asked for, no results: it is
/// another row than that of the same step where others keep its results.
Hash128 StepRun::row_key() const {
  return made_when_asked() ? joined_key(recall_key_, {0x61736b6564, 0}) : recall_key_;
}

/// What is made when it is asked for is not recalled from a step of the same run: whether all of
/// that was asked for by now hangs on threads. What is kept says once, however many passes recall
/// it.
bool StepRun::recall() {
  Store* store = state_.results.store();
  if (!store || !store->index()) return false;
  recall_key_ = find_recall_key();
  const Hash128 row = row_key();
  NotedKeys &unknown = state_.results.unknown(), &said = state_.results.said();
  const bool says = made_when_asked() || said.note(joined_key(row, hash_of(plan_.path)));
  if (!(made_when_asked() && unknown.has(row)) && take_recalled(says)) return true;
  // Of kept ones the first: the others say nothing of what it made.
  remembers_ = unknown.note(row) || made_when_asked();
  return false;
}

/// Takes over what is remembered, if anything is. With workers only what they will find.
bool StepRun::take_recalled(bool says) {
  auto known = find_recalled();
  if (!known) return false;
  const bool whole = !itemwise() && !lazy(), items = itemwise() && keeping_ != Keeping::passing;
  if (state_.executor.elsewhere() && (whole || items) && !all_in_store(*known)) return false;
  if (whole && !take_numbers(known->numbers)) return numbers_.clear(), false;
  said_in_full_ = true;
  if (whole || items) {
    const auto keys = whole ? std::span<const Hash128>(&known->whole, 1) : known->items;
    state_.results.store()->hold(keys);
    std::size_t earlier = 0;
    for (const Hash128& key : keys) earlier += state_.results.said().note(key) ? 1 : 0;
    state_.books.step_begins(plan_.path, state_.pass, keys.size());
    state_.books.all_reused(plan_.path, state_.pass, keys.size());
    state_.books.from_earlier_run(plan_.path, earlier);
    recalled_ = true;
  }
  if (says) say_recalled(*known);
  facts_ = std::move(known->facts);
  if (whole) whole_key_ = known->whole, whole_keys_ = std::move(known->values);
  if (items) {
    kept_keys_ = std::move(known->items);
    items_ = kept_keys_.size();
    pins_.resize(items_);
  }
  if (whole || items) list_source_ = source_of_list();
  return true;
}

/// What is made when it is asked for counts the same as where it was kept.
std::optional<Recalled> StepRun::find_recalled() const {
  if (state_.results.fresh()) return std::nullopt;
  Index& index = *state_.results.store()->index();
  auto known = index.recalled(row_key());
  if (!known && made_when_asked()) known = index.recalled(recall_key_);
  if (known && !fits(*known)) known.reset();
  return known;
}

/// Of a source its call has just said a part of that.
void StepRun::say_recalled(const Recalled& known) {
  StoredResult said;
  for (const CountOf& count : known.counts) {
    const auto at = counts_.find(count.what);
    const std::uint64_t by_call = at == counts_.end() ? 0 : at->second;
    said.counts.emplace_back(count.what, count.n - std::min(count.n, by_call));
  }
  said.warnings = known.warnings;
  say_again(said);
}

/// Whether it can be what a step of this kind left.
bool StepRun::fits(const Recalled& known) const {
  if (lazy() || itemwise()) return true;
  const auto& outputs = plan_.description->outputs;
  if (known.values.size() != outputs.size() || known.numbers.size() != outputs.size()) return false;
  for (std::size_t o = 0; o < outputs.size(); ++o)
    if (outputs[o].emission == Emission::one && known.values[o].size() != 1) return false;
  return true;
}

bool StepRun::all_in_store(const Recalled& known) {
  Results& results = state_.results;
  const auto there = [&](const Hash128& key) {
    if (!results.store()->contains(key)) return false;
    results.made_elsewhere(key, plan_.description->name);
    return true;
  };
  if (!itemwise()) return there(known.whole);
  return std::all_of(known.items.begin(), known.items.end(), there);
}

/// False when they cannot be read.
bool StepRun::take_numbers(const std::vector<std::string>& bytes) {
  const auto& outputs = plan_.description->outputs;
  numbers_.resize(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    if (bytes[o].empty()) continue;
    const Type& type = *outputs[o].type;
    try {
      InArchive in(bytes[o]);
      numbers_[o] = {&type, type.code->read(in)};
      if (!in.at_end() || *type.code->fault(numbers_[o].value.get())) return false;
    } catch (const Error&) {
      return false;
    }
  }
  return true;
}

/// Where the list of the items is that this step's values belong to, without opening it.
Source StepRun::source_of_list() {
  const auto& ports = plan_.description->inputs;
  for (std::size_t p = 0; itemwise() && p < ports.size(); ++p) {
    if (inputs_[p].empty()) continue;
    const Source& source = inputs_[p].front();
    if (plan_.description->lists_items(ports[p])) return source;
    if (ports[p].access == Access::item && source.run->per_item(source.output) &&
        source.run->list_source().run)
      return source.run->list_source();
  }
  for (std::size_t o = 0; !itemwise() && o < plan_.description->outputs.size(); ++o)
    if (const Source* source = source_over(o); source && source->run->list_source().run)
      return source->run->list_source();
  return {};
}

/// Remembers what this step gave, for later runs. Of what is made whenever it is asked for only
/// when all of it was: then what it counted is complete.
void StepRun::remember() {
  if (!remembers_ || dropped_) return;
  // What workers say of what passes through their calls does not come home in full.
  if (made_when_asked() && (state_.executor.elsewhere() || noted_ < values_when_asked())) return;
  Recalled known;
  known.items = kept_keys_;
  if (!itemwise() && !lazy()) {
    known.whole = whole_key_;
    known.values = whole_keys_;
    known.numbers = bytes_of_numbers();
  }
  const std::lock_guard lock(said_mutex_);
  for (const auto& [what, n] : counts_) known.counts.push_back({what, n});
  known.warnings.assign(warnings_.begin(), warnings_.end());
  known.facts = facts_;
  state_.results.store()->index()->set_recalled(row_key(), std::move(known));
}

std::vector<std::string> StepRun::bytes_of_numbers() {
  const auto& outputs = plan_.description->outputs;
  std::vector<std::string> all(outputs.size());
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    if (!outputs[o].type->has_numbers || outputs[o].emission != Emission::one) continue;
    const AnyValue value = this->value(static_cast<int>(o));
    OutArchive<TextSink> out;
    value.type->code->write(value.value.get(), out);
    if (out.text.size() <= most_bytes_of_numbers) all[o] = std::move(out.text);
  }
  return all;
}

/// So many values there are that are made when they are asked for.
std::size_t StepRun::values_when_asked() const {
  if (itemwise()) return items_;
  std::size_t n = 0;
  for (std::size_t o = 0; o < whole_keys_.size(); ++o)
    if (plan_.description->outputs[o].emission == Emission::lazy) n += whole_keys_[o].size();
  return n;
}

/// Keeps what a call said, so that a later run can say it too.
void StepRun::note(const StoredResult& said) {
  const std::lock_guard lock(said_mutex_);
  for (const auto& [what, n] : said.counts) counts_[what] += n;
  warnings_.insert(said.warnings.begin(), said.warnings.end());
}

/// As note, of what is made when it is asked for, once each; also when it failed.
void StepRun::note_first(const StoredResult& said) {
  note(said);
  if (++noted_ == values_when_asked()) remember();
}

}  // namespace plumb
