#pragma once
/// What the command line gave a pipeline to read.

#include <filesystem>
#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// The values of path parameters that come from the command line: what a stranger's pipeline may
/// read.
std::vector<std::filesystem::path> given_paths(const Plan& plan);

}  // namespace plumb
