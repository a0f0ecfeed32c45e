#pragma once
/// The pipeline of each run of an experiment, read and checked.

#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/plugin/registry.hpp"
#include "plumb/slam/experiment/experiment.hpp"

namespace plumb::experiment {

/// All variants: the pipeline as it is under the name that it has, those of the experiment, those
/// of its sweep. Throws Error: two of one name, a name that is none for a folder; PipelineError
/// where the pipeline cannot be read.
std::vector<Variant> all_variants(const Experiment& experiment, const Registry& registry);

/// What a variant runs on an input in a replicate (from 0). The input sets the parameter `input`,
/// and beside it what lies in its folder and the pipeline asks for: truth.tum, plan.txt, and as
/// `estimate` what another program of the variant's name made of it, NAME.tum. Throws Error: the
/// input is not there, the pipeline has no parameter `input`; PipelineError with all other
/// mistakes.
Plan cell_plan(const Experiment& experiment, const Variant& variant, const Input& input,
               std::size_t replicate, const Registry& registry);

/// Throws Error where a disturbance of the replicates would not be the same for all variants: one
/// whose frames cannot be left out, or something that no variant has. `plans`: of the undisturbed
/// run of each variant.
void require_disturbable(const Experiment& experiment, const std::vector<Variant>& variants,
                         const std::vector<const Plan*>& plans);

}  // namespace plumb::experiment
