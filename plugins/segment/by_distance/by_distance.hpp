#pragma once
/// Where segments of an equal length of path begin.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace plumb::segment_by_distance {

/// The length of segments [m] that makes at most `max_segments` of a path [m]: not less than
/// `length`, nor more than `max_length` (none: `length`).
double grown_length(double path, double length, std::optional<double> max_length,
                    std::size_t max_segments);

/// First frames of segments that are at most `length` [m] long: a frame begins a new one when it is
/// farther than that along the path from its segment's first frame, or would be its frame number
/// `max_frames` (from 0). `travelled` is the path [m] from the first frame to each. A last segment
/// that is under half in both senses joins the one before it, unless both together would reach
/// twice `length`. Empty for no frames. Where `breaks(first, k)` is given, frame k also begins a
/// new segment when it is true for the frame k and its segment's first; a last segment that it
/// parts from the one before stays. The first segment is shorter than the others by the share
/// `phase` (0 to 0.5) of `length`, which moves all cuts. Ours.
std::vector<std::size_t> starts_by_distance(
    const std::vector<double>& travelled, double length, std::optional<std::size_t> max_frames,
    const std::function<bool(std::size_t first, std::size_t k)>& breaks = {}, double phase = 0);

}  // namespace plumb::segment_by_distance
