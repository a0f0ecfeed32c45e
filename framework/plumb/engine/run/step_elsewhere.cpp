/// Calls in other processes: what becomes of them here, and what a worker makes.
#include "plumb/data/error.hpp"
#include "plumb/engine/plan/step_key.hpp"
#include "plumb/engine/run/step_run.hpp"
#include "plumb/store/blob.hpp"

namespace plumb {

void StepRun::take(const Reply& reply) {
  book(reply);
  if (reply.machinery) throw NestedError(reply.fault);
  if (!reply.fault.empty()) return;
  const std::size_t k = reply.item;
  bool there = lazy() || has_result(k);
  if (there && !lazy()) state_.results.made_elsewhere(key_of_call(k), plan_.description->name);
  if (there && !itemwise()) there = take_whole_from(reply);
  if (!there)
    throw NestedError(
        title(k) +
        ": its result did not come into the cache; is the folder the same for all processes?");
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
  ready();
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

void StepRun::adopt(std::vector<Hash128> keys, std::vector<std::vector<Hash128>> values,
                    Source list) {
  if (list.run) list_ = list.run->value(list.output);
  list_source_ = std::move(list);
  if (itemwise()) {
    kept_keys_ = std::move(keys);
    items_ = kept_keys_.size();
    pins_.resize(items_);
  } else {
    whole_key_ = keys.at(0);
    whole_keys_ = std::move(values);
  }
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

}  // namespace plumb
