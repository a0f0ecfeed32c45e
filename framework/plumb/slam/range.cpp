#include "plumb/slam/range.hpp"

#include <limits>

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb {

FrameRange range_of(const Trajectory& trajectory, std::size_t first, std::size_t end) {
  if (first >= end || end > trajectory.size())
    throw Error("frames " + std::to_string(first) + " to " + std::to_string(end) +
                " (not included) are not a range of a trajectory of " +
                counted(trajectory.size(), "poses"));
  constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
  if (end - first > most)
    throw Error("the segment from frame " + std::to_string(first) + " to frame " +
                std::to_string(end - 1) + " would have " + std::to_string(end - first) +
                " frames, but at most " + std::to_string(most) +
                " are possible: cut into shorter segments");
  FrameRange range;
  range.first = static_cast<std::uint32_t>(first);
  range.end = static_cast<std::uint32_t>(end);
  range.T_world_segment = trajectory.T_world_frame[range.middle()];
  const Pose T_segment_world = range.T_world_segment.inverse();
  range.T_segment_frame.reserve(end - first);
  for (std::size_t k = first; k < end; ++k)
    range.T_segment_frame.push_back(T_segment_world * trajectory.T_world_frame[k]);
  return range;
}

std::vector<FrameRange> ranges_from(const Trajectory& trajectory,
                                    const std::vector<std::size_t>& starts) {
  std::vector<FrameRange> ranges;
  ranges.reserve(starts.size());
  for (std::size_t k = 0; k < starts.size(); ++k)
    ranges.push_back(
        range_of(trajectory, starts[k], k + 1 < starts.size() ? starts[k + 1] : trajectory.size()));
  return ranges;
}

Poses poses_of(const std::vector<FrameRange>& ranges) {
  Poses poses;
  poses.T_world_segment.reserve(ranges.size());
  for (const FrameRange& range : ranges) poses.T_world_segment.push_back(range.T_world_segment);
  return poses;
}

Poses poses_of(const std::vector<FrameRange>& ranges, const Trajectory& trajectory) {
  Poses poses;
  poses.T_world_segment.reserve(ranges.size());
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (ranges[k].end > trajectory.size())
      throw Error("segment " + std::to_string(k) + " has frames up to " +
                  std::to_string(ranges[k].end) + ", the trajectory only " +
                  std::to_string(trajectory.size()) + ": wire ranges of the same frames");
    poses.T_world_segment.push_back(trajectory.T_world_frame[ranges[k].middle()]);
  }
  return poses;
}

}  // namespace plumb
