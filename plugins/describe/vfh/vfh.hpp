#pragma once
/// Viewpoint feature histogram: one vector of 308 numbers for the shape of a whole cloud and how it
/// is seen.

#include <optional>
#include <vector>

#include "plumb/slam/cloud.hpp"

namespace plumb::describe_vfh {

inline constexpr std::size_t vfh_size = 308;

/// From where the normals are looked at.
enum class Viewpoint {
  origin,  ///< of the cloud's coordinates
  above    ///< straight down, from infinitely far
};

struct VfhOptions {
  Viewpoint viewpoint = Viewpoint::origin;
  bool distances = false;  ///< whether the histogram of distances is filled

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.choice(
          "viewpoint", &VfhOptions::viewpoint,
          {{"origin", Viewpoint::origin, "where the sensor stood at the segment's middle frame"},
           {"above", Viewpoint::above, "straight down: the normals' inclinations are counted"}})
        .doc("from where the normals are looked at");
    is.param("distances", &VfhOptions::distances)
        .doc(
            "whether the points' distances from the centroid, by the largest, are counted too; PCL "
            "leaves these 45 numbers 0");
  }
};

/// The VFH of the points with normals; the numbers sum to 1. With c the centroid and n the mean of
/// the normals, of every point are counted
///   the three angles of the pair (c, n) and the point in its Darboux frame  (0-44, 45-89, 90-134)
///   the distance from c by the largest, if `distances`                      (135-179)
///   the cosine between its normal and the direction from c to the viewpoint (180-307)
/// Nothing where fewer than three points have normals, or no two of them differ. Throws Error where
/// the cloud has no normals. Source: [Rusu2010]; PCL's VFHEstimation.
std::optional<std::vector<float>> vfh(const Cloud& cloud, const VfhOptions& options);

}  // namespace plumb::describe_vfh
