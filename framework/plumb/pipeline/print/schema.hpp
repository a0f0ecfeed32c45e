#pragma once
/// The JSON Schema of pipelines and presets, from what the steps declare: completion and checks
/// while one types.

#include <string>

#include "plumb/plugin/registry.hpp"

namespace plumb {

/// Draft-07. Says what the reader says, as far as a schema can: not what a name refers to, nor the
/// range of a number with a unit.
std::string pipeline_schema(const Registry& registry);

}  // namespace plumb
