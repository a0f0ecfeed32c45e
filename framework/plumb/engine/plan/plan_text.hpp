#pragma once
/// What a run of a plan will do and hold, as a table, for `plumb check --plan`.

#include <string>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// A line a step, in the order in which they begin: what one call sees, how long the results live
/// and why. Below, which steps run together. What depends on the data, as the numbers of items and
/// the memory do, is not in it.
std::string plan_text(const Plan& plan);

}  // namespace plumb
