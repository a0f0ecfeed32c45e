#pragma once
/// The pipeline that results, as YAML, each value with the place that it came from.

#include "plumb/pipeline/bind/draft.hpp"

namespace plumb::pipeline {

std::string resolved_text(const Draft& draft);

}  // namespace plumb::pipeline
