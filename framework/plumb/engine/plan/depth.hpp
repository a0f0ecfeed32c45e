#pragma once
/// Which steps of a plan could run side by side.

#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// How many steps and repeats the longest path to each has, itself included, within its level: the
/// pipeline, or the body of a repeat. What has one depth on one level is joined by no path.
struct Depths {
  std::vector<int> steps, repeats;  ///< as in Plan
};

Depths depths_of(const Plan& plan);

}  // namespace plumb
