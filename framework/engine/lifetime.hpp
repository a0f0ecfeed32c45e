#pragma once
/// What a plan says, before it runs, on how long each step's results must live.

#include <vector>

#include "plumb/engine/step_run.hpp"

namespace plumb {

/// For each step: the place in Plan::order after which nobody asks for its results any more.
std::vector<std::size_t> last_uses(const Plan& plan);

/// For each step: whether its items pass through, are kept, or are remembered too.
std::vector<Keeping> keeping_of(const Plan& plan);

}  // namespace plumb
