#pragma once
/// Signatures of histograms of orientations: 352 numbers for the surface round a point.

#include <cstdint>
#include <optional>
#include <vector>

#include "plumb/slam/values.hpp"

namespace plumb::describe_shot {

inline constexpr std::size_t shot_size = 352;

struct ShotOptions {
  double radius = 2.5;                    ///< [m] of a neighbourhood
  std::optional<double> lrf_radius = {};  ///< [m] of the local reference frame's; none: `radius`
  double border_angle = 90 * deg;         ///< [rad] a wider gap between neighbours makes a border

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("radius", &ShotOptions::radius)
        .unit("m")
        .range(0.01, 100)
        .doc("radius of a point's neighbourhood");
    is.param("lrf_radius", &ShotOptions::lrf_radius)
        .unit("m")
        .range(0.01, 100)
        .doc("radius of the neighbourhood that the local reference frame follows; none: 'radius'");
    is.param("border_angle", &ShotOptions::border_angle)
        .unit("rad")
        .range(45 * deg, 360 * deg)
        .source("PCL, BoundaryEstimation")
        .doc(
            "a keypoint is at the border if its neighbours leave a sector free that is wider than "
            "this");
  }
};

struct Shot {
  Features features;                 ///< dimension 352, each vector of length 1
  std::vector<std::uint32_t> index;  ///< of each keypoint in the cloud
  std::size_t left_out = 0;          ///< keypoints without a normal or without a frame
};

/// Describes the points `keys` of `cloud`, in that order, the points that have normals being the
/// support. A point with fewer than five neighbours has no local reference frame and is left out.
/// Throws Error where the cloud has no normals. Source: [Tombari2010]; PCL's SHOTEstimation, and
/// its BoundaryEstimation for `at_border`.
Shot shot(const Cloud& cloud, const std::vector<std::uint32_t>& keys, const ShotOptions& options);

}  // namespace plumb::describe_shot
