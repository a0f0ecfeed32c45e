#pragma once
/// The text of a pipeline with the names of now: edited at its places, so that comments, order and
/// layout stay.

#include <string>
#include <vector>

#include "plumb/pipeline/yaml/diagnostics.hpp"
#include "plumb/pipeline/yaml/renaming.hpp"

namespace plumb::pipeline {

/// `text` of `file` after `renamings`, which all lie in it. A place that cannot be edited, such as
/// one behind an alias, is told.
std::string rewritten(const std::string& text, const std::string& file,
                      const std::vector<Renaming>& renamings, Diagnostics& diagnostics);

}  // namespace plumb::pipeline
