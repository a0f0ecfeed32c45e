#pragma once
/// The last stage: a pipeline in which nothing is faulty, as the engine takes it.

#include <vector>

#include "plumb/pipeline/check/checks.hpp"

namespace plumb::pipeline {

/// `order` and `domains` are those of `bound`. Throws std::logic_error when something in it is
/// faulty: all of that was told, and who raised what was told does not come here.
Plan plan_of(const Bound& bound, const Order& order, const Domains& domains,
             std::vector<Renaming> renamings);

}  // namespace plumb::pipeline
