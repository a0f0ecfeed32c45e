#pragma once
/// Where segments of an equal number of frames begin.

#include <cstddef>
#include <vector>

namespace plumb::segment_by_count {

/// First frames of segments of `per_segment` (at least 1) of `frames` frames. A last segment of
/// less than half as many joins the one before it. The first segment has the share `phase` (0 to
/// 0.5) of `per_segment` fewer frames, at least 1, which moves all cuts. Empty for no frames.
/// Source: [Tang2024] 2.2; the short last segment and the phase are ours.
std::vector<std::size_t> starts_by_count(std::size_t frames, std::size_t per_segment,
                                         double phase = 0);

/// How many of `frames` frames a segment has if they are cut into about `segments` (at least 1):
/// their share, rounded up, at least 1. Source: [Tang2024] 2.2 has the number of frames follow from
/// that of all frames and does not say how: the share is ours.
std::size_t frames_for(std::size_t frames, std::size_t segments);

}  // namespace plumb::segment_by_count
