#pragma once
/// What compare is asked to compare: an experiment's file, or a pipeline with the variants and
/// inputs of the command line, which are also added to those of a file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "plumb/slam/experiment/experiment.hpp"

namespace plumb::command {

class Command;  // command_line.hpp

struct ExperimentOptions {
  std::filesystem::path file;
  std::vector<std::string> variants, sweeps, sets, metrics, timed;
  std::vector<std::filesystem::path> inputs;
  std::string sweep_by, primary, margin;
  std::size_t replicates = 0;  ///< 0: as the file says, or 1
  int seed = -1;               ///< of the replicates; -1: as the file says, or 0

  void add_to(Command command);
  /// Whether `file` is an experiment, and no pipeline.
  bool of_file() const;
  /// Throws UsageError for what is wrong on the command line, Error, and PipelineError.
  experiment::Experiment asked() const;
};

}  // namespace plumb::command
