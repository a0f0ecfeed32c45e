#pragma once
/// The passes of every repeat as a table, for `plumb check`.

#include <string>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// One table a repeat: a line a pass, a column a row; the last line for passes that repeat the last
/// column. A row that an overlay left without a use is named below. Empty without repeats.
std::string passes_table(const Plan& plan);

}  // namespace plumb
