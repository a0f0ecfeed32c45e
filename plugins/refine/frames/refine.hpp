#pragma once
/// Each frame by itself registered to the segments round it.

#include <functional>
#include <memory>
#include <vector>

#include "plumb/slam/segment.hpp"

namespace plumb::refine_frames {

struct FrameOptions {
  double max_correspondence_distance = 1;          ///< [m]
  double final_max_correspondence_distance = 0.5;  ///< [m]
  std::uint32_t max_iterations = 6;
  std::uint32_t max_points = 800;
  double noise = 0.1;  ///< [m]
  std::uint32_t max_weight = 100;
  double translation_sigma = 0.1;     ///< [m]
  double rotation_sigma = 0.3 * deg;  ///< [rad]

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("max_correspondence_distance", &FrameOptions::max_correspondence_distance)
        .unit("m")
        .range(1e-3, 100)
        .doc("distance between the two points of a correspondence, in the first iteration");
    is.param("final_max_correspondence_distance", &FrameOptions::final_max_correspondence_distance)
        .unit("m")
        .range(1e-3, 100)
        .doc("the same in the last iteration");
    is.param("max_iterations", &FrameOptions::max_iterations)
        .range(1, 1000)
        .doc("iterations of point-to-plane ICP");
    is.param("max_points", &FrameOptions::max_points)
        .range(30, 1e9)
        .doc("points of a frame that are matched, evenly selected");
    is.param("noise", &FrameOptions::noise)
        .unit("m")
        .range(1e-4, 100)
        .doc("scale of the Cauchy loss on the distance to the plane, and its standard deviation");
    is.param("max_weight", &FrameOptions::max_weight)
        .range(1, 1e9)
        .doc("total weight of all correspondences of a frame");
    is.param("translation_sigma", &FrameOptions::translation_sigma)
        .unit("m")
        .range(1e-6, 1e3)
        .doc(
            "standard deviation of a frame's position in the input: a prior for directions that "
            "its points do not constrain");
    is.param("rotation_sigma", &FrameOptions::rotation_sigma)
        .unit("rad")
        .range(1e-6 * deg, 360 * deg)
        .doc("standard deviation of its orientation");
  }
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
