#pragma once
/// From registrations to the relations of a pose graph.

#include <span>

#include "plumb/data/graph.hpp"
#include "plumb/data/registration.hpp"

namespace plumb {

/// One relation for each accepted registration that knows something (its information is not zero),
/// with the standard deviations multiplied by `inflate`. Planar when there is one and none leaves
/// the plane.
Relations collected(const Edges& edges, std::span<const Registration> registrations,
                    double inflate);

}  // namespace plumb
