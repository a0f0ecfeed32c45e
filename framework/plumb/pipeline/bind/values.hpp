#pragma once
/// How what stands in the tree is read: maps with known keys, and values that may be those of the
/// pipeline's parameters.

#include <string>
#include <vector>

#include "plumb/pipeline/bind/declared.hpp"
#include "plumb/pipeline/yaml/value.hpp"

namespace plumb::pipeline {

/// A value and where it is written: at the parameter of the pipeline, when it comes from there.
struct Value {
  ParameterValue value;
  Origin origin;
};

/// The value that `node` writes, or that the parameter of the pipeline has that it refers to by
/// $name. Faults are told as "PLACE: ...".
OrFaulty<Value> value_of(Reading& reading, const Settings& settings, const std::string& place,
                         const ParameterDescription& parameter, const Node& node);

/// Reports keys that are not `known`; false when `node` is no map.
bool check_keys(Diagnostics& diagnostics, const Node& node, const std::string& what,
                const std::vector<std::string>& known);

}  // namespace plumb::pipeline
