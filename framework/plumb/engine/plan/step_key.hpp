#pragma once
/// What a step's results are remembered under: its name, version and the parameters that affect the
/// result.

#include "plumb/data/error.hpp"
#include "plumb/data/hash.hpp"
#include "plumb/plugin/description.hpp"

namespace plumb {

Hash128 step_key(const StepDescription& step, const ParameterValues& values);
/// Of the files and folders that the parameters name: path, size and time of the last change. A
/// file that is none counts by its path.
Hash128 files_key(const StepDescription& step, const ParameterValues& values);
Hash128 joined_key(const Hash128& a, const Hash128& b);

/// An error that already names the step and item it came from; a step that opened that item passes
/// it on unchanged.
class NestedError : public Error {
 public:
  using Error::Error;
};

/// What a step threw, as a sentence for whoever runs the pipeline.
std::string sentence_of(const std::exception& thrown);

}  // namespace plumb
