#pragma once
/// The schema of one step, and of values. Internal to the schema writer.

#include <nlohmann/json.hpp>

#include "plumb/plugin/description.hpp"

namespace plumb::pipeline {

using Json = nlohmann::ordered_json;

/// A word that refers to a parameter of the pipeline or to a row.
inline constexpr const char* reference_pattern = "\\$[A-Za-z0-9_]+";

/// What may be written for a parameter: values with units as patterns, bare ones with their range,
/// `none`, `$name`.
Json schema_of_value(const ParameterDescription& parameter);

/// `with` and `from` of one step: {"properties": {...}, "required": [...]}.
Json schema_of_step(const StepDescription& step);

}  // namespace plumb::pipeline
