#pragma once
/// Steps that a build left out because a library was not found: a file beside the modules, which
/// the build writes (plumb_leave_out in PlumbStep.cmake) and whoever misses a step is told of.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace plumb {

/// By the step's name: why, and the cure ("PCL was not found; install libpcl-dev and build again").
using StepsLeftOut = std::map<std::string, std::string, std::less<>>;

/// Of lines "STEP: WHY". Throws Error, which names `file` and the line, at any other.
StepsLeftOut read_left_out(std::string_view text, const std::filesystem::path& file);

/// Beside the modules of a folder; empty where no build has written any. Throws Error when the file
/// may not be read (trusted_file.hpp) or is not what a build writes.
StepsLeftOut left_out_beside(const std::filesystem::path& modules);

}  // namespace plumb
