#pragma once
/// What a replicate disturbs in a pipeline: parameters that its steps have for that.

#include <string>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/slam/experiment/experiment.hpp"

namespace plumb::experiment {

/// What `replicate` (from 0) sets in the steps of a plan, as "STEP.PARAMETER=VALUE": skip_frames,
/// drop_frames and drop_seed of sources, phase of steps that cut, seed of steps that draw. The
/// values are drawn from the replicates' seed, the number of the replicate and the name of the
/// input alone, so that they are the same for all variants, and others for each input: drawn once
/// for all inputs, what three skipped frames do to an error would move all of them alike, and
/// tests that take inputs as independent would find differences where there are none. None of the
/// first replicate.
std::vector<std::string> disturbances(const Replicates& replicates, std::size_t replicate,
                                      const std::string& input, const Plan& plan);

/// What is to be disturbed and no step of the plan has: "drop_frames".
std::vector<std::string> not_disturbed(const Replicates& replicates, const Plan& plan);

}  // namespace plumb::experiment
