#pragma once
/// Keypoints where the normals look in three directions: Harris corners in space.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::keypoints_harris3d {

/// What of the normals' second moments tells a corner.
enum class Response {
  harris,  ///< the determinant, 0 to 1/27
  tomasi   ///< the least eigenvalue, 0 to 1/3
};

struct HarrisOptions {
  Response response = Response::harris;
  double radius = 1.5;       ///< [m] of the neighbourhood, and of what one keypoint stands for
  double threshold = 0.003;  ///< of the response

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.choice("response", &HarrisOptions::response,
              {{"harris", Response::harris, "the determinant of the moments, from 0 to 1/27"},
               {"tomasi", Response::tomasi, "the least eigenvalue of the moments, from 0 to 1/3"}})
        .doc("what tells a corner");
    is.param("radius", &HarrisOptions::radius)
        .unit("m")
        .range(0.01, 100)
        .doc(
            "radius of the neighbourhood whose normals are taken, and within which only the "
            "strongest point becomes a keypoint");
    is.param("threshold", &HarrisOptions::threshold)
        .range(1e-6, 1.0 / 3)
        .doc("response that a keypoint must have");
  }
};

/// Indices of the keypoints, ascending: of the points with normals those whose response is at least
/// `threshold` and no less than that of any point within `radius`. The response is that of the
/// mean of n n' over the normals n within `radius`. Throws Error where the cloud has no normals.
/// Source: PCL's HarrisKeypoint3D, without its refinement; compare [Sipiran2011].
std::vector<std::uint32_t> harris3d(const Cloud& cloud, const HarrisOptions& options);

}  // namespace plumb::keypoints_harris3d
