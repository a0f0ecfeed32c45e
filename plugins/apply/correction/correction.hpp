#pragma once
/// From the segments' new poses to every frame's.

#include <vector>

#include "plumb/slam/graph.hpp"
#include "plumb/slam/segment.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb::apply_correction {

/// The trajectory after each segment moved from `ranges[s].T_world_segment` to
/// `poses.T_world_segment[s]`.
///
/// Unblended, a frame moves with its segment. With `blend`, a frame between the middles of two
/// neighbouring segments takes both segments' ideas of its pose, by its share of the path length
/// (of the frames, where nothing was travelled), slerp and linear: so the trajectory has no step
/// where one segment ends, and one rigid motion of all stays exactly that. Before the first middle
/// and behind the last a frame moves with its segment. Throws Error when there are not as many
/// poses as ranges, or the ranges do not cover the trajectory frame by frame.
Trajectory corrected(const Trajectory& trajectory, const std::vector<FrameRange>& ranges,
                     const Poses& poses, bool blend);

}  // namespace plumb::apply_correction
