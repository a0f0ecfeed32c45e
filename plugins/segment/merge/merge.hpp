#pragma once
/// Merges the frames of a range into one segment.

#include <functional>

#include "plumb/slam/segment.hpp"

namespace plumb::segment_merge {

/// Gives frame k of a range, from 0; asked once for each, in order, and each is let go before the
/// next.
using OpenFrame = std::function<std::shared_ptr<const Frame>(std::size_t k)>;

/// The points of all frames in the segment's coordinates [m], in order of the frames, moved in
/// float by range.T_segment_frame. Normals are turned. An array that some frame with points lacks
/// is dropped.
Segment merge(const FrameRange& range, const OpenFrame& open);

/// What VoxelMeans makes of that in cells of `voxel_size` [m], one frame after another: the merged
/// cloud itself is never in memory. `dropped`: points with a non-finite coordinate.
Segment merge_thinned(const FrameRange& range, double voxel_size, const OpenFrame& open,
                      std::size_t& dropped);

}  // namespace plumb::segment_merge
