#pragma once
/// What is judged of a bound pipeline; each check is a file. What is faulty is passed over: it was
/// told of where it was found.

#include <string>
#include <vector>

#include "plumb/pipeline/bind/bound.hpp"

namespace plumb::pipeline {

/// Steps and repeats in an order in which they can run, level by level.
struct Order {
  std::vector<PlannedItem> items;                ///< of the pipeline
  std::vector<std::vector<PlannedItem>> bodies;  ///< by repeat
};
/// As far as there is one: a cycle is told.
Order order_of(const Bound& bound, Diagnostics& diagnostics);

/// By step: of one that works item by item, the step whose output says which items there are; else
/// -1.
using Domains = std::vector<int>;
Domains domains_of(const Bound& bound, const Order& order, Diagnostics& diagnostics);

/// `judged`: the text was made of a pipeline that was checked, so that parameters, rows and steps
/// that nothing uses were left so on purpose.
void check_unused(const Bound& bound, bool judged, Diagnostics& diagnostics);
/// What is set on the command line for nothing, because an overlay left it without a use.
std::vector<std::string> warnings_of(const Bound& bound);

/// Paths that lead nowhere.
void check_missing_files(const Bound& bound, Diagnostics& diagnostics);
/// The same, and paths that the command line did not give: they are not looked at.
void check_foreign_paths(const Bound& bound, Diagnostics& diagnostics);

}  // namespace plumb::pipeline
