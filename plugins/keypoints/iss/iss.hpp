#pragma once
/// Keypoints where the surface bends in all directions: intrinsic shape signatures.

#include <cstdint>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::keypoints_iss {

struct IssOptions {
  double salient_radius = 1.8;        ///< [m] of the neighbourhood that is judged
  double non_max_radius = 1.2;        ///< [m] within which one keypoint is kept
  double gamma_21 = 0.975;            ///< e2 / e1 must be less
  double gamma_32 = 0.975;            ///< e3 / e2 must be less
  std::uint32_t min_neighbours = 10;  ///< the point itself counts

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("salient_radius", &IssOptions::salient_radius)
        .unit("m")
        .range(0.01, 100)
        .doc("radius of the neighbourhood whose scatter is judged");
    is.param("non_max_radius", &IssOptions::non_max_radius)
        .unit("m")
        .range(0.01, 100)
        .doc("of the points within this radius only the most salient one becomes a keypoint");
    is.param("gamma_21", &IssOptions::gamma_21)
        .range(0.01, 1)
        .source("PCL, ISSKeypoint3D")
        .doc("bound on the second eigenvalue of the scatter over the first");
    is.param("gamma_32", &IssOptions::gamma_32)
        .range(0.01, 1)
        .source("PCL, ISSKeypoint3D")
        .doc("bound on the third eigenvalue of the scatter over the second");
    is.param("min_neighbours", &IssOptions::min_neighbours)
        .range(3, 100000)
        .doc("points that both neighbourhoods must hold, the point itself included");
  }
};

/// Indices of the keypoints, ascending. With e1 >= e2 >= e3 the eigenvalues of a point's scatter
/// sum (q - p)(q - p)' over the points q within `salient_radius` of p, p is one if e2 / e1 <
/// gamma_21, e3 / e2 < gamma_32 and no point within `non_max_radius` that meets both has a greater
/// e3. Scatters without thickness (e3 <= 1e-9 e1) have no keypoints. Points must be finite. Source:
/// [Zhong2009]; PCL's ISSKeypoint3D, which takes the sum unweighted.
std::vector<std::uint32_t> iss(const Cloud& cloud, const IssOptions& options);

}  // namespace plumb::keypoints_iss
