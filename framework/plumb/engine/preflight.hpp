#pragma once
/// What only the modules themselves can say of a checked pipeline, said before anything runs.

#include "plumb/pipeline/bind/plan.hpp"
#include "plumb/plugin/registry.hpp"

namespace plumb {

/// Loads the pipeline's modules and asks each step whether its parameters go together, in every
/// pass. Looks at the names of the files that steps will write. Throws PipelineError with the
/// places.
void preflight(const Plan& plan, const Registry& registry);

}  // namespace plumb
