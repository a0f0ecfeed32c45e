#pragma once
/// Generalized ICP: plane to plane.

#include "plumb/slam/cloud.hpp"
#include "shared/pcl/registering.hpp"

namespace plumb::register_gicp {

struct GicpOptions {
  std::uint32_t neighbours = 20;         ///< of a point's covariance, where there are no normals
  double transformation_epsilon = 1e-3;  ///< [m] converged when an iteration moves less
  double rotation_epsilon = 1e-3;        ///< [rad] and turns less
  std::uint32_t max_iterations = 50;

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("neighbours", &GicpOptions::neighbours)
        .range(4, 1000)
        .doc("nearest points that a point's covariance is taken from where it has no normal");
    is.param("transformation_epsilon", &GicpOptions::transformation_epsilon)
        .unit("m")
        .range(1e-6, 1)
        .doc("converged when an iteration moves the pose by less along each axis");
    is.param("rotation_epsilon", &GicpOptions::rotation_epsilon)
        .unit("rad")
        .range(1e-6, 0.1)
        .doc("and when it turns the pose by less");
    is.param("max_iterations", &GicpOptions::max_iterations).range(1, 10000).doc("iterations");
  }
};

/// The motion of `source` to `target` by pairs of nearest points up to
/// `max_correspondence_distance` [m], each weighed by the inverse of C_target + R C_source R', from
/// `start` on. The covariance of a point with the normal n is I - (1 - 1e-3) n n', that of one
/// without a normal I; of a cloud without normals, PCL's from the nearest points. Not converged
/// with fewer than four pairs, or too few points. Source: [Segal2009]; PCL's
/// GeneralizedIterativeClosestPoint.
pcl::Aligned gicp(const Cloud& target, const Cloud& source, const Pose& start,
                  double max_correspondence_distance, const GicpOptions& options);

}  // namespace plumb::register_gicp
