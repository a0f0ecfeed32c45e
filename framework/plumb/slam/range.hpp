#pragma once
/// Cutting a trajectory into ranges of frames, one for each segment.

#include "plumb/slam/graph.hpp"
#include "plumb/slam/segment.hpp"
#include "plumb/slam/trajectory.hpp"

namespace plumb {

/// The range of frames first .. end-1, its coordinates those of its middle frame. Throws Error when
/// it is empty, reaches beyond the trajectory, or has more than 65535 frames (a point names its
/// frame in 16 bits).
FrameRange range_of(const Trajectory& trajectory, std::size_t first, std::size_t end);

/// The ranges that begin at frames `starts` (rising, the first one 0) and together cover the
/// trajectory. Errors as range_of.
std::vector<FrameRange> ranges_from(const Trajectory& trajectory,
                                    const std::vector<std::size_t>& starts);

/// Where the ranges' segments are, as the odometry has it.
Poses poses_of(const std::vector<FrameRange>& ranges);

/// Where they are as another trajectory of the same frames has it: the poses of their middle
/// frames. Throws Error when a range reaches beyond the trajectory.
Poses poses_of(const std::vector<FrameRange>& ranges, const Trajectory& trajectory);

}  // namespace plumb
