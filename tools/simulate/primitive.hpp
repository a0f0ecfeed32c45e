#pragma once
/// What the simulated world is built of besides the ground: boxes, upright cylinders and
/// ellipsoids.

#include <Eigen/Core>
#include <cstdint>

#include "plumb/slam/geometry/box.hpp"

namespace plumb::simulate {

/// A half-line in the world; `direction` has length 1, so that t is metres.
struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;
  Eigen::Vector3f at(float t) const { return origin + t * direction; }
};

/// Where a ray ends: distance [m], outward unit normal, share of light thrown back (0 to 1).
struct Hit {
  float t = std::numeric_limits<float>::infinity();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float reflectance = 0;
};

/// Openings (windows, doors, shop fronts) recessed into the four sides of a building; which bay of
/// which floor has one, and how large it is, follows from `seed`, so that no two houses look alike.
struct Facade {
  std::uint64_t seed = 0;
  float base = 0;            ///< height of the pavement in front [m]
  float ground_floor = 3.5;  ///< its height [m]
  float floor = 3.0;         ///< height of the others [m]
  float bay = 3.0;           ///< distance between openings [m]
  float width = 1.2;         ///< mean width of an opening [m]
  float height = 1.6;        ///< height of a window [m]
  float depth = 0.25;        ///< of a window in the wall [m]
};

/// One solid, turned about the vertical by the angle with cosine `cosine` and sine `sine`.
struct Primitive {
  enum class Kind : std::uint8_t { box, cylinder, ellipsoid };
  Kind kind = Kind::box;
  std::int32_t facade = -1;  ///< index into the world's facades; -1: smooth
  float reflectance = 0.4f;
  float cosine = 1, sine = 0;
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  Eigen::Vector3f half =
      Eigen::Vector3f::Ones();  ///< half lengths; radius, radius, half height; semi-axes
};

/// The smallest upright box round `p`.
Box bounds(const Primitive& p);

/// Where `ray` enters `p` (whose facade, if any, is `facade`), if that is nearer than `hit.t`: then
/// `hit` is replaced. A ray that starts inside does not see the solid.
bool intersect(const Primitive& p, const Facade* facade, const Ray& ray, Hit& hit);

}  // namespace plumb::simulate
