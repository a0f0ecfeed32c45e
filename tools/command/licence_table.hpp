#pragma once
/// What `plumb list --licences` prints.

#include <iosfwd>

#include "plumb/plugin/registry.hpp"

namespace plumb::command {

/// Each module under the licences that whoever loads it accepts: its file, its steps, and the
/// reason where one is stated. Modules that did not come with Plumb are named by their path.
void print_licences(std::ostream& out, const Registry& steps);

}  // namespace plumb::command
