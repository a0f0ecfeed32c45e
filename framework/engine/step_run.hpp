#pragma once
/// One step of a plan in one pass, with its inputs joined: what it is asked for, it makes, remembers or passes through.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "plumb/engine/bookkeeping.hpp"
#include "plumb/engine/memo.hpp"
#include "plumb/pipeline/plan.hpp"
#include "plumb/plugin/step.hpp"
#include "plumb/store/store.hpp"

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
  Memo& memo;
  Store* store = nullptr;  ///< none: results live no longer than the run
  bool fresh = false;      ///< nothing is taken from it
};

/// How long the items of a step live.
enum class Keeping {
  passing,     ///< made anew whenever asked for: frames, and clouds that only one following step takes
  kept,        ///< made once, kept as long as someone may ask
  remembered,  ///< kept, and also looked up and stored in the memo: the step may come again with the same inputs
};

class StepRun : public std::enable_shared_from_this<StepRun> {
 public:
  StepRun(const PlannedStep& plan, const Step& step, const ParameterValues& values,
          std::vector<std::vector<Source>> inputs, Keeping keeping, RunState state);

  /// Makes everything that is to be kept: the whole step, or all its items in parallel.
  void start();

  const PlannedStep& plan() const { return plan_; }
  bool itemwise() const;                          ///< one call a frame, segment or edge
  std::size_t items() const { return items_; }    ///< calls, for an item-wise step
  /// How many values `output` has: 1 for a value of the whole pipeline.
  std::size_t count(int output) const;
  /// Value k of an output, made or fetched. Throws Error that names step and item.
  AnyValue value(int output, std::size_t k = 0);
  /// Changes whenever that value would.
  Hash128 key(int output, std::size_t k = 0);
  /// The edges that edge-wise values of this run belong to.
  std::shared_ptr<const Edges> edges() const { return edges_; }

 private:
  std::vector<AnyValue> make(std::size_t k, const Hash128& key);
  std::vector<PortInput> gather(std::size_t k);
  Hash128 call_key(std::size_t k);
  void hash_input(Hasher& hasher, std::size_t port, std::size_t k);
  void find_items();
  void start_whole();
  void check_items(std::size_t output);
  std::pair<std::size_t, std::size_t> frames_of(std::size_t k) const;
  std::string item_name(std::size_t k) const;
  std::vector<PortOutput> call(std::size_t k, StoredResult* said = nullptr);
  std::optional<StoredResult> stored(const Hash128& key);
  std::uint64_t seed_of(const std::vector<PortInput>& inputs) const;
  void run_fold(std::vector<PortOutput>& outputs, StoredResult* said);
  bool first_asked(int output, std::size_t k);

  const PlannedStep& plan_;
  const Step& step_;
  std::shared_ptr<const void> params_;
  Hash128 base_key_, files_key_;
  std::vector<std::vector<Source>> inputs_;
  Keeping keeping_;
  RunState state_;

  std::size_t items_ = 0;
  std::shared_ptr<const Edges> edges_;
  std::vector<std::vector<AnyValue>> kept_;  ///< by item, then output
  std::vector<Hash128> kept_keys_;           ///< by item
  std::vector<PortOutput> whole_;            ///< of a step on whole collections, by output
  std::vector<std::vector<Hash128>> whole_keys_;
  std::vector<std::unique_ptr<std::atomic<bool>[]>> asked_;  ///< of what is made anew whenever asked for: by output, then item
};

}  // namespace plumb
