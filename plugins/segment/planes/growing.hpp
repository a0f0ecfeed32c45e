#pragma once
/// Planes of a cloud by region growing, by CGAL.

#include "planes.hpp"

namespace plumb::segment_planes {

struct GrowingOptions {
  double radius = 1;                   ///< [m] of a neighbourhood
  double max_plane_distance = 0.1;     ///< [m] of a point from its plane
  double max_normal_angle = 15 * deg;  ///< [rad] between a point's normal and its plane's
  std::uint32_t min_points = 100;      ///< of a plane

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("radius", &GrowingOptions::radius)
        .unit("m")
        .range(0.01, 100)
        .doc("a plane grows from a point to those within this distance");
    is.param("max_plane_distance", &GrowingOptions::max_plane_distance)
        .unit("m")
        .range(0.001, 100)
        .doc("distance of a point from its plane");
    is.param("max_normal_angle", &GrowingOptions::max_normal_angle)
        .unit("rad")
        .range(0, 90 * deg)
        .doc("angle between a point's normal and that of its plane");
    is.param("min_points", &GrowingOptions::min_points)
        .range(3, 1e9)
        .doc("planes with fewer points are none");
  }
};

/// The planes of a segment with normals. Each begins at a point that is on none yet, those first
/// whose neighbours' normals differ least from their own; it takes the neighbours that are within
/// the options' distance and angle of it, then theirs, and is fitted anew after each round. Points
/// without a normal are on none. Normals' signs do not matter; a plane's looks to where the sensor
/// stood for most of its points. Nothing is drawn. Source: [Lafarge2012], CGAL's Region_growing;
/// the order of the seeds is ours.
Planes grow_planes(const Segment& segment, const GrowingOptions& options);

}  // namespace plumb::segment_planes
