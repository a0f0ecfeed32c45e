#pragma once
/// What registrations by PCL have in common: a motion in its numbers and back, and what PCL does
/// not tell of one: how many points have a pair, how far off these are, and what they fix.

#include "plumb/slam/registration.hpp"
#include "plumb/slam/segment.hpp"

namespace plumb::pcl {

/// How PCL left a registration.
struct Aligned {
  Pose T_i_j;
  std::uint32_t iterations = 0;
  bool converged = false;
};

/// The motion as a matrix of floats, and one that PCL found as a pose: identity and `converged`
/// false where its numbers are no motion.
Eigen::Matrix4f matrix_of(const Pose& pose);
Aligned aligned_by(const Eigen::Matrix4f& matrix, int iterations, bool converged);

struct FitOptions {
  double max_correspondence_distance = 0.5;  ///< [m] between the points of a pair
  double min_overlap = 0.5;                  ///< share of the points that must have a pair
  std::uint32_t independent = 50;            ///< as so many independent pairs all of them count
  bool planar = false;  ///< the clouds lie in the plane z = 0: only x, y and yaw are kept

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("max_correspondence_distance", &FitOptions::max_correspondence_distance)
        .unit("m")
        .range(1e-3, 100)
        .doc("distance between the two points of a pair");
    is.param("min_overlap", &FitOptions::min_overlap)
        .range(0, 1)
        .doc("share of the points that must have a pair for the registration to be accepted");
    is.param("independent", &FitOptions::independent)
        .range(1, 1e9)
        .doc("number of independent correspondences that the information is computed for");
    is.param("planar", &FitOptions::planar)
        .doc("the clouds come from a 2-D laser: only x, y and yaw are kept");
  }
};

/// The registration of j's points to i's with the motion found (`start` where it did not converge),
/// judged by the nearest point of i of each point of j: `information` is sum J'J / s^2 as
/// register.features takes it, J being the derivative of a pair's distance by a motion in j's axes,
/// along i's normal, or in all directions where i has no normals; s^2 the mean square of that
/// distance, at least (1 cm)^2. Accepted if it converged, at least `min_overlap` of j's points have
/// a pair and some direction is fixed.
Registration judged(const Segment& i, const Cloud& j, const Aligned& found, const Pose& start,
                    const FitOptions& options);

}  // namespace plumb::pcl
