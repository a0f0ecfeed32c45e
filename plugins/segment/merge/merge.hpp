#pragma once
/// Merges the frames of a range into one segment.

#include <functional>

#include "plumb/data/segment.hpp"

namespace plumb {

/// The points of all frames in the segment's coordinates [m], in order of the frames, moved in
/// float by range.T_segment_frame. `open(k)` gives frame k of the range (from 0); it is called once
/// for each, in order, and a frame is let go before the next. Normals are turned. An array that
/// some frame with points lacks is dropped.
Segment merge(const Range& range,
              const std::function<std::shared_ptr<const Frame>(std::size_t k)>& open);

}  // namespace plumb
