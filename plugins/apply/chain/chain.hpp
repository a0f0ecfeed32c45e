#pragma once
/// A trajectory from the registrations of a chain.

#include <span>

#include "plumb/slam/graph.hpp"
#include "plumb/slam/registration.hpp"

namespace plumb::apply_chain {

struct ChainOptions {
  double weak_translation_sigma = 0.5;    ///< [m] standard deviation of what was not registered
  double weak_rotation_sigma = 30 * deg;  ///< [rad] of its rotation
};

struct Chained {
  Poses poses;
  Constraints constraints;
  std::size_t replaced = 0;      ///< registrations that were not accepted
  std::size_t interpolated = 0;  ///< segments that no edge reaches, between two that one does
  std::size_t starts = 0;        ///< segments after the first where a chain starts anew
};

/// Composes T_j = T_i T_i_j in order of j, from `initial`. Where several edges end in j, the one
/// with the nearest i counts, an accepted one before one that is not. A registration that is not
/// accepted is replaced by the initial relative pose. The first segment of the chain stays at its
/// initial pose; one in which no edge ends follows the one placed before it as the initial poses
/// have it. Segments that no edge touches lie between their placed neighbours, by index
/// (interpolate()), and outside of all as the initial poses have it relative to the nearest placed
/// one. Without any edge the poses are the initial ones.
///
/// `constraints` has one for each edge, its information by metres and q.vec (half the angle), as
/// solve.pose_graph takes it: that of the registration, or where it was not accepted or has none
/// that of the weak standard deviations. They are planar when no motion leaves the plane. Throws
/// Error when there are not as many poses as segments in `edges`.
Chained chained(const Poses& initial, const Edges& edges,
                std::span<const Registration> registrations, const ChainOptions& options);

}  // namespace plumb::apply_chain
