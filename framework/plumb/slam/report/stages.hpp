#pragma once
/// What a measure's numbers are named after.

#include <string>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// The labels of the inputs of which a step takes several, as written: the stages that it measures.
/// A measure's numbers are called "STAGE" or "STAGE.NAME".
std::vector<std::string> stages_of(const PlannedStep& step);

/// Whether a number is of that stage.
bool is_of_stage(const std::string& number, const std::string& stage);

}  // namespace plumb
