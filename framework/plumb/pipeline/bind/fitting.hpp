#pragma once
/// Which outputs an input port takes.

#include <string>

#include "plumb/pipeline/bind/binding.hpp"

namespace plumb::pipeline {

bool fits(const StepDescription& step, const InputDescription& input, const Source& source);
/// "Features, one per segment": what a port wants.
std::string wanted(const StepDescription& step, const InputDescription& input);

}  // namespace plumb::pipeline
