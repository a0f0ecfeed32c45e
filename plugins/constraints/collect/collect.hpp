#pragma once
/// From registrations to the constraints of a pose graph.

#include <span>

#include "plumb/slam/graph.hpp"
#include "plumb/slam/registration.hpp"

namespace plumb::constraints_collect {

/// One constraint for each accepted registration that knows something (its information is not
/// zero), with the standard deviations multiplied by `inflate`. Planar when there is one and none
/// leaves the plane.
Constraints collected(const Edges& edges, std::span<const Registration> registrations,
                      double inflate);

}  // namespace plumb::constraints_collect
