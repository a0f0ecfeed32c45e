#pragma once
/// What the steps and repeats of one level of a plan wait for: of the pipeline, or of a repeat's
/// body.

#include <vector>

#include "plumb/pipeline/bind/plan.hpp"

namespace plumb {

/// By item of the level, as places in it.
struct Level {
  std::vector<std::vector<std::size_t>> before;  ///< earlier ones that it waits for, in order
  std::vector<std::vector<std::size_t>> after;   ///< later ones that wait for it, in order
};

/// An item waits for those that it draws on. It also waits for those with a step that one of its
/// own may be like, of the same name and with the same parameters: then it does not hang on
/// threads which of the two makes a result and which finds it made.
Level level_of(const Plan& plan, const std::vector<PlannedItem>& items);

}  // namespace plumb
