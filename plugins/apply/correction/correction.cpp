#include "correction.hpp"

#include "plumb/data/counted.hpp"
#include "plumb/data/error.hpp"

namespace plumb::apply_correction {
namespace {

void check(const Trajectory& trajectory, const std::vector<FrameRange>& ranges,
           const Poses& poses) {
  if (poses.size() != ranges.size())
    throw Error("got " + counted(poses.size(), "poses") + " but " +
                counted(ranges.size(), "ranges") + "; wire ranges and poses of the same segments");
  std::uint32_t next = 0;
  for (const auto& range : ranges) {
    if (range.first != next || range.end <= range.first)
      throw Error("the ranges leave out frame " + std::to_string(next) +
                  "; wire the ranges that the trajectory was cut into");
    next = range.end;
  }
  if (next != trajectory.size())
    throw Error("the ranges cover " + counted(next, "frames") + ", the trajectory has " +
                std::to_string(trajectory.size()) +
                "; wire the ranges that the trajectory was cut into");
}

/// Frame in the middle of a range, whose coordinates the segment has.
std::size_t middle(const FrameRange& range) { return range.first + (range.end - range.first) / 2; }

}  // namespace

Trajectory corrected(const Trajectory& trajectory, const std::vector<FrameRange>& ranges,
                     const Poses& poses, bool blend) {
  check(trajectory, ranges, poses);
  const auto way = travelled(trajectory);
  const auto by = [&](std::size_t segment, std::size_t frame) {
    return poses.T_world_segment[segment] *
           (ranges[segment].T_world_segment.inverse() * trajectory.T_world_frame[frame]);
  };
  Trajectory result;
  result.stamps = trajectory.stamps;
  result.T_world_frame.reserve(trajectory.size());
  for (std::size_t s = 0; s < ranges.size(); ++s) {
    for (std::size_t frame = ranges[s].first; frame < ranges[s].end; ++frame) {
      // The two segments whose middles lie round the frame; the same one twice at the ends of the
      // run.
      const bool early = frame < middle(ranges[s]);
      const std::size_t a = early && s > 0 ? s - 1 : s;
      const std::size_t b = !early && s + 1 < ranges.size() ? s + 1 : s;
      if (!blend || a == b) {
        result.T_world_frame.push_back(by(s, frame));
        continue;
      }
      const std::size_t from = middle(ranges[a]), to = middle(ranges[b]);
      const double length = way[to] - way[from];
      const double share = length > 1e-6
                               ? (way[frame] - way[from]) / length
                               : static_cast<double>(frame - from) / static_cast<double>(to - from);
      result.T_world_frame.push_back(interpolate(by(a, frame), by(b, frame), share));
    }
  }
  return result;
}

}  // namespace plumb::apply_correction
