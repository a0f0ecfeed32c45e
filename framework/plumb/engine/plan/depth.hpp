#pragma once
/// Which steps of a plan run together.

#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// How many steps and repeats the longest chain of those that wait for each other has that ends
/// with each (level.hpp), itself included, within its level: the pipeline, or the body of a repeat.
/// Of those with one depth on one level none waits for another.
struct Depths {
  std::vector<int> steps, repeats;  ///< as in Plan
};

Depths depths_of(const Plan& plan);

}  // namespace plumb
