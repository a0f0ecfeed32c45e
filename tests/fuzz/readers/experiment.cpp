#include "plumb/slam/experiment/experiment.hpp"

#include "../fuzz.hpp"

using namespace plumb;

/// An experiment, and the variants of its sweep.
PLUMB_FUZZ_READER(experiment) {
  const auto read = experiment::read_experiment(fuzz::file_of(bytes, "experiment.yaml"));
  fuzz::require(!read.primary.empty(), "an experiment names the number that decides");
  fuzz::require(read.replicates.count >= 1, "there is a replicate");
  for (const auto& variant : experiment::swept_variants(read.axes, read.sweep_by))
    fuzz::require(!variant.swept.empty() && variant.edits.size() == variant.swept.size(),
                  "a variant of a sweep sets what it is called by");
}
