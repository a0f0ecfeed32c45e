#pragma once
/// The nearest name to a wrong one, for error messages.

#include <string>
#include <vector>

#include "plumb/data/error.hpp"

namespace plumb::simulate {

/// "Did you mean 'x'?" where one of `known` is near to `wrong`, and in any case the list of them.
std::string suggestion(const std::string& wrong, const std::vector<std::string>& known);

}  // namespace plumb::simulate
