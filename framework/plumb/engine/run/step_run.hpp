#pragma once
/// One step of a plan in one pass, with its inputs joined: what it is asked for, it makes,
/// remembers or passes through.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "plumb/engine/cache/explain.hpp"
#include "plumb/engine/cache/results.hpp"
#include "plumb/engine/observe/bookkeeping.hpp"
#include "plumb/engine/plan/lifetime.hpp"
#include "plumb/engine/run/executor.hpp"
#include "plumb/engine/run/failures.hpp"
#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/plugin/step.hpp"
#include "plumb/store/index.hpp"

namespace plumb {

class StepRun;

/// An output of a step in some pass.
struct Source {
  std::shared_ptr<StepRun> run;
  int output = -1;
  std::string label;  ///< for an input that takes several
};

/// What all step runs of a run share.
struct RunState {
  Bookkeeping& books;
  Results& results;
  Executor& executor;
  int pass = -1;                            ///< of the innermost repeat around the step
  const std::atomic<bool>* stop = nullptr;  ///< set when a step has failed: no call begins then
  /// In a worker: takes what steps count whose frames pass through a call, instead of the books.
  std::function<void(const StepRun& run, std::size_t output, std::size_t item,
                     const StoredResult& said)>
      passed = nullptr;
};

/// One step in one pass, for whoever asks it: for its items, their keys, its values.
///
/// One thread starts it; when start() has returned, and what it gave is explained and remembered,
/// others may ask it, several at a time. Nothing that they read changes any more but what is
/// atomic, behind said_mutex_ or made once behind a once_flag.
///
/// Larger than a class should be (tests/tree/size_test.py): whether a value is recalled, found,
/// made here or elsewhere, passes through or was dropped is one state that all of these questions
/// read and change. By file: step_call (one call), step_items, step_whole, step_elsewhere (calls in
/// other processes), step_recall, step_facts.
class StepRun : public std::enable_shared_from_this<StepRun> {
 public:
  StepRun(const PlannedStep& plan, const Step& step, ParameterValues values,
          std::vector<std::vector<Source>> inputs, Keeping keeping, RunState state);

  /// Makes everything that is to be kept, the whole step or all its items, unless an earlier run
  /// left all of it. Throws LeftOut (schedule.hpp) when another step failed meanwhile.
  void start();
  /// Remembers what was made for later runs. Asked after start(), with the facts; what is made when
  /// it is asked for is remembered then if nobody need ask, else when all of it was asked for.
  void remember();
  /// Makes one call and keeps what it gave. Throws NestedError when the call fails.
  void make_here(std::size_t k);
  /// Takes over what another process made of a call: books what it said, and, unless it failed,
  /// finds its result. Throws NestedError when the call is not to blame.
  void take(const Reply& reply);
  /// Whether calls that have not begun are to be left out: too many failed, or another step did.
  bool stopped() const { return failures_.enough() || (state_.stop && *state_.stop); }
  /// Memory that a call on an item may need [bytes], about.
  std::size_t expected_bytes(std::size_t k);
  /// In a worker: takes over what another process made and put into the store, by its keys: one an
  /// item, or that of a whole step with the hashes of its values, by output.
  void adopt(std::vector<Hash128> keys, std::vector<std::vector<Hash128>> values, Source list);
  /// In a worker: joins the inputs of a step whose calls are asked for one by one.
  void join();
  /// In a worker: makes one call, puts its result into the store under the `expected` key unless
  /// the step has lazy outputs, and writes down what became of it. Throws MachineryError when the
  /// key is another here or the store does not take the result, Error when the call fails.
  void make_one(std::size_t k, const Hash128& expected, Reply& reply);

  const PlannedStep& plan() const { return plan_; }
  const ParameterValues& values() const { return values_; }
  Keeping keeping() const { return keeping_; }
  const std::vector<std::vector<Source>>& inputs() const { return inputs_; }
  bool itemwise() const { return plan_.description->itemwise(); }  ///< one call an item
  bool lazy() const;                               ///< has outputs that are made when asked for
  std::size_t items() { return ready(), items_; }  ///< calls, for an item-wise step
  const std::vector<Hash128>& item_keys() const { return kept_keys_; }
  const Hash128& whole_key() const { return whole_key_; }
  const std::vector<std::vector<Hash128>>& whole_keys() const { return whole_keys_; }
  const Source& list_source() { return ready(), list_source_; }
  /// "step 'coarse.matches' (match.fpfh_mutual), edge 3-4".
  std::string title(std::size_t k);
  std::string item_name(std::size_t k);  ///< "edge 3-4"; empty for a step on whole collections
  /// Asked after start(), with a store.
  const Facts& facts();

  /// How many values `output` has: 1 for a value of the whole pipeline.
  std::size_t count(int output);
  /// Value k of an output, made or fetched. Throws Error that names step and item.
  AnyValue value(int output, std::size_t k = 0);
  /// Changes whenever that value would.
  Hash128 key(int output, std::size_t k = 0);
  /// Of items that are listed (edges): the list that the values of this run belong to.
  const AnyValue& list();
  /// Whether an output has one value an item, and not one for the whole pipeline.
  bool per_item(int output) const {
    return itemwise() || plan_.description->outputs[output].emission != Emission::one;
  }
  /// What value k of an output takes in memory [bytes], about; 0 when nobody knows yet.
  std::size_t size_of(int output, std::size_t k);
  /// Books what was counted in another process of a value that passes through, once however often
  /// it is made.
  void book_passed(const PassedCounts& passed);
  /// Whether another process put the result of call k into the store; what its step said is said
  /// again then.
  bool adopt_result(std::size_t k);
  /// Whether the result of call k is in the store, and removes it from there.
  bool has_result(std::size_t k) const { return state_.results.store()->contains(key_of_call(k)); }
  void remove_result(std::size_t k) { state_.results.store()->remove(key_of_call(k)); }
  /// Says a sentence about this step while it runs, once.
  void say(const std::string& sentence) { state_.books.warn(plan_.path, sentence); }
  /// Throws Error unless other processes can get this run's results from the store.
  void require_in_store() const;

 private:
  // step_call.cpp: what one call sees
  std::vector<PortInput> gather(std::size_t k);
  Hash128 call_key(std::size_t k);
  void hash_input(Hasher& hasher, std::size_t port, std::size_t k);
  std::pair<std::size_t, std::size_t> parts_of(std::size_t k, const Source& parts);
  ItemPlace place_of(std::size_t k);
  SeenPart part_of(std::size_t port, std::size_t k);
  std::vector<PortOutput> call(std::size_t k, StoredResult* said, bool again = false);
  void run_call(const std::vector<PortInput>& inputs, std::vector<PortOutput>& outputs,
                Context& context, std::size_t k);
  void require_sound(const AnyValue& value, std::size_t output) const;
  void check_outputs(const std::vector<PortOutput>& outputs, std::size_t k);
  // step_recall.cpp: what an earlier run left
  Hash128 find_recall_key() const;
  Hash128 row_key() const;
  bool recall();
  bool take_recalled(bool says);
  std::optional<Recalled> find_recalled() const;
  void say_recalled(const Recalled& known);
  bool fits(const Recalled& known) const;
  bool all_in_store(const Recalled& known);
  bool take_numbers(const std::vector<std::string>& bytes);
  Source source_of_list();
  std::vector<std::string> bytes_of_numbers();
  bool made_when_asked() const { return lazy() || keeping_ == Keeping::passing; }
  std::size_t values_when_asked() const;
  void note(const StoredResult& said);
  void note_first(const StoredResult& said);
  /// Of what passes through and was recalled, finds the items when they are first asked for.
  void ready() {
    if (keeping_ == Keeping::passing) std::call_once(joined_, [this] { find_inputs(); });
  }
  void find_inputs();
  /// As list(), asked while or after the inputs are found.
  const AnyValue& own_list() { return recalled_ ? list() : list_; }
  // step_items.cpp: the items of an item-wise step
  void find_items();
  void require_ends();
  void start_items();
  std::vector<std::size_t> find_keys();
  void reuse(std::vector<std::size_t>& items);
  void settle();
  SharedResult fetch(std::size_t k);
  std::vector<AnyValue> pass(std::size_t k);
  // step_whole.cpp: a step on whole collections
  void start_whole();
  void take_whole(std::vector<PortOutput> outputs, StoredResult said);
  bool find_whole();
  bool take_whole_from(const Reply& reply);
  void name_values();
  void check_items(std::size_t output);
  const Source* source_over(std::size_t output) const;
  SharedResult whole();
  // both
  void make(const std::vector<std::size_t>& calls);
  const Hash128& key_of_call(std::size_t k) const {
    return itemwise() ? kept_keys_[k] : whole_key_;
  }
  bool first_asked(std::size_t output, std::size_t k);
  std::string misfit_of(const StoredResult& result) const;
  std::optional<std::size_t> values_of(std::size_t output) const;
  SharedResult find(const Hash128& key);
  void say_again(const StoredResult& result);
  void book(const Reply& reply);
  StoredResult result_of(std::vector<PortOutput>& outputs, StoredResult said) const;
  SharedResult kept(const Hash128& key, StoredResult result, SharedResult& pin);

  const PlannedStep& plan_;
  const Step& step_;
  ParameterValues values_;
  std::shared_ptr<const void> params_;
  Hash128 base_key_, files_key_;
  std::vector<std::vector<Source>> inputs_;
  Keeping keeping_;
  RunState state_;

  std::size_t items_ = 0;
  Source list_source_;  ///< where list_ comes from
  AnyValue list_;
  std::vector<Hash128> kept_keys_;  ///< by item
  std::vector<SharedResult> pins_;  ///< by item: what the store did not take
  Hash128 whole_key_;
  SharedResult whole_pin_;       ///< of a step on whole collections, unless it may leave memory
  std::vector<LazyItems> lazy_;  ///< by output
  std::vector<std::vector<Hash128>> whole_keys_;
  Hash128 recall_key_;
  bool recalled_ = false;      ///< all its results are known from an earlier run, by their keys
  bool said_in_full_ = false;  ///< what it counts was said already
  bool dropped_ = false;       ///< an item failed and has an empty value
  bool remembers_ = false;     ///< what it makes is to be remembered for later runs
  Failures failures_{plan_.on_error == OnError::stop || !itemwise()};
  std::vector<AnyValue> numbers_;  ///< by output: recalled values with numbers
  Facts facts_;
  std::once_flag joined_, listed_;
  std::mutex said_mutex_;
  std::map<std::string, std::uint64_t> counts_;
  std::set<std::string> warnings_;
  std::vector<std::unique_ptr<std::atomic<bool>[]>>
      asked_;  ///< of what is made anew whenever asked for: by output, then item
  std::atomic<std::size_t> noted_ = 0;         ///< of these so many whose counts are in counts_
  std::atomic<std::size_t> passed_bytes_ = 0;  ///< the biggest value that passed so far
};

}  // namespace plumb
