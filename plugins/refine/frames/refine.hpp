#pragma once
/// Each frame by itself registered to the segments round it.

#include <functional>
#include <memory>
#include <vector>

#include "plumb/data/segment.hpp"

namespace plumb::refine_frames {

struct FrameOptions {
  double max_correspondence_distance =
      1;  ///< [m] farthest that a point and its nearest may be apart, in the first iteration
  double final_max_correspondence_distance = 0.5;  ///< [m] in the last
  std::uint32_t max_iterations = 6;
  std::uint32_t max_points = 800;  ///< of the frame, evenly chosen
  double noise = 0.1;  ///< [m] scale of the robust loss (Cauchy), and a point's standard deviation
  std::uint32_t max_weight = 100;     ///< the points together weigh at most so many
  double translation_sigma = 0.1;     ///< [m] of the frame's pose as it comes
  double rotation_sigma = 0.3 * deg;  ///< [rad]
};

/// A segment to register to, and where it lies.
struct Target {
  std::shared_ptr<const Segment> segment;  ///< with normals
  Pose T_world_segment;
};

struct FramePose {
  Pose T_world_frame;
  std::uint32_t pairs = 0;  ///< in the last iteration
};

/// Point-to-plane ICP of `cloud` onto all targets at once, from T_world_frame, which also holds it
/// with the two deviations. In each target's own coordinates a point has at most one nearest; it
/// counts once for each target that sees it. Fewer than 30 pairs: the pose stays.
FramePose registered(const Cloud& cloud, const Pose& T_world_frame,
                     const std::vector<Target>& targets, const FrameOptions& options);

}  // namespace plumb::refine_frames
