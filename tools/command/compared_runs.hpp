#pragma once
/// The runs of an experiment: checked all, then made one after the other.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "plumb/data/error.hpp"
#include "plumb/engine/observe/observer.hpp"
#include "plumb/engine/record/output_folder.hpp"
#include "plumb/plugin/registry.hpp"
#include "plumb/slam/experiment/experiment.hpp"
#include "plumb/slam/experiment/measured.hpp"
#include "plumb/slam/report/alike.hpp"

namespace plumb {
class SizeBound;
class Store;
}  // namespace plumb

namespace plumb::command {

/// What holds for all runs.
struct RunsOptions {
  unsigned threads = 0;
  Store* store = nullptr;
  SizeBound* bound = nullptr;
  bool fresh = false;          ///< nothing is taken from the store
  bool quiet = false;          ///< no line for each run
  bool fail_fast = false;      ///< the first failure ends it
  Observer* events = nullptr;  ///< hears of all runs
};

class ComparedRuns {
 public:
  /// Reads and checks the pipeline of every run, so that all that can be refused is refused before
  /// the first one. Throws Error, PipelineError.
  ComparedRuns(const experiment::Experiment& experiment, const Registry& steps);

  /// The modules' own checks (preflight), a run of each variant.
  void preflight_all() const;
  /// Where each run's results are kept: OUTPUT/VARIANT/INPUT, and of several replicates
  /// OUTPUT/VARIANT/INPUT/replicate_N.
  std::vector<std::filesystem::path> places(const std::filesystem::path& output) const;
  /// Makes sure that they can be. Throws Error.
  void keep_in(const std::filesystem::path& output);

  const std::vector<experiment::Variant>& variants() const { return variants_; }
  const experiment::Measured& measured() const { return measured_; }
  /// Makes all runs; what fails is in measured(). Throws NothingMeasured when the first run does
  /// not give what is to be compared, and FailedFast.
  void make(const RunsOptions& options);

  bool settled() const { return settled_; }  ///< what was put in place is as it should be
  std::size_t stamps_left_out() const { return stamps_left_out_; }

 private:
  struct Run {
    Plan plan;
    std::unique_ptr<OutputFolder> folder = nullptr;  ///< none: nothing is kept
  };
  std::size_t index(std::size_t variant, std::size_t input, std::size_t replicate) const {
    return (variant * measured_.inputs.size() + input) * measured_.replicates + replicate;
  }
  /// "coarse on street, replicate 2".
  std::string title(std::size_t variant, std::size_t input, std::size_t replicate) const;
  void make_beside(std::size_t input, std::size_t replicate, const RunsOptions& options);
  void make_one(Run& run, RunBeside& beside, const std::string& title, const RunsOptions& options);
  void require_measured(const experiment::Cell& cell) const;

  const experiment::Experiment& experiment_;
  const Registry& steps_;
  std::vector<experiment::Variant> variants_;
  experiment::Measured measured_;
  std::vector<Run> runs_;  ///< as the cells of measured_
  std::string unmatched_;  ///< what the first run did not give, as a sentence
  bool settled_ = true;
  std::size_t stamps_left_out_ = 0;
};

/// What is to be compared is not there.
class NothingMeasured : public Error {
 public:
  using Error::Error;
};
/// The first failure, with --fail-fast.
class FailedFast : public Error {
 public:
  using Error::Error;
};

}  // namespace plumb::command
