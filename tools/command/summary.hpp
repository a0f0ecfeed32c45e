#pragma once
/// What `plumb run` prints at the end.

#include <filesystem>
#include <ostream>

#include "plumb/engine/run/runner.hpp"

namespace plumb::command {

/// A table of the numbers that the measures gave, what is weak, how loops ended, where the files
/// are; with `times` what each step took.
void print_summary(std::ostream& out, const Plan& plan, const RunResult& result,
                   const std::filesystem::path& folder, bool times);

/// Only what is weak, as the solvers and measures say it; with `warnings` what was said while they
/// ran, too.
void print_weak(std::ostream& out, const RunResult& result, bool warnings);

}  // namespace plumb::command
