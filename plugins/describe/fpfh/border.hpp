#pragma once
/// Whether a point lies at the border of its cloud, where its neighbourhood, hence its feature, is
/// cut off.

#include "pair_counts.hpp"

namespace plumb::describe_fpfh {

/// The largest angle [rad] between two directions, one after the other, in which neighbours lie as
/// seen from `point` along its normal; 2 pi if there is no neighbour elsewhere than straight along
/// the normal. Gaps under 45 degrees are not told apart: they may be given as 0. Source: [Rusu2008]
/// as PCL's BoundaryEstimation has it. [Tang2024] 2.3.2 drops pairs near edges, after [Xiong2018].
double largest_gap(const Oriented& point, const Candidates& candidates, float squared_radius);

}  // namespace plumb::describe_fpfh
