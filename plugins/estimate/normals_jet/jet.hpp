#pragma once
/// Normals of the surfaces that fit the neighbours of each point, by CGAL.

#include "shared/neighbourhood/normals.hpp"

namespace plumb::estimate_normals_jet {

struct JetOptions {
  std::uint32_t degree = 2;  ///< of the polynomial; 1 is a plane
  /// Of the standard deviations along the neighbours' three axes: the middle one is at least this
  /// share of the greatest ...
  double min_width = 1e-3;
  double max_thickness = 1;  ///< ... and the least at most this share of the middle one

  /// As parameters of a step.
  template <class Declare>
  static void describe(Declare& is) {
    is.param("degree", &JetOptions::degree)
        .range(1, 4)
        .doc("of the surface: 1 is a plane, 2 has curvatures");
    is.param("min_width", &JetOptions::min_width)
        .unit("%")
        .range(0, 1)
        .doc(
            "a neighbourhood whose width is less than this share of its length is a line, such as "
            "a single scan line, and has no normal");
    is.param("max_thickness", &JetOptions::max_thickness)
        .unit("%")
        .range(0, 1)
        .doc(
            "a neighbourhood whose thickness is more than this share of its width is no surface, "
            "such as foliage, and has no normal");
  }
};

/// The unit normal, up to sign, at the first of `points`, which is the origin, of the polynomial of
/// `degree` in the plane that fits best whose heights fit all points best. Zero if there are fewer
/// points than it has coefficients, (degree + 1)(degree + 2) / 2, or the shares are not met.
/// Source: [Cazals2005].
Eigen::Vector3f jet_normal(const std::vector<Eigen::Vector3f>& points, const JetOptions& options);

/// Writes nx, ny, nz of `cloud` as neighbourhood::write_normals does, by jet_normal. Returns how
/// many points have no normal.
std::size_t jet_normals(Cloud& cloud, const SearchTree& tree, const neighbourhood::Bounds& bounds,
                        const JetOptions& options,
                        const std::function<Eigen::Vector3f(std::size_t)>& origin,
                        Context& context);

}  // namespace plumb::estimate_normals_jet
