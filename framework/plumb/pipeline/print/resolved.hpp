#pragma once
/// The pipeline that results, as YAML, each value with the place that it came from.

#include <string>

#include "plumb/pipeline/bind/bound.hpp"

namespace plumb::pipeline {

/// By the names of now. Throws std::logic_error when something is faulty.
std::string resolved_text(const Bound& bound);

}  // namespace plumb::pipeline
