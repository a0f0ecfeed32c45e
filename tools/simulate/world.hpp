#pragma once
/// A world to scan: the ground and the solids on it.

#include <Eigen/Core>
#include <vector>

#include "plumb/slam/geometry/pose.hpp"
#include "simulate/bvh.hpp"
#include "simulate/ground.hpp"
#include "simulate/primitive.hpp"

namespace plumb::simulate {

/// Everything in float coordinates about `origin` (where the path begins), so that millimetres
/// survive far from zero.
class World {
 public:
  World(const Eigen::Vector3d& origin, Ground ground, std::vector<Primitive> primitives,
        std::vector<Facade> facades);

  /// What each ray meets first within `range` [m]; an infinite t if nothing.
  Hits cast(const Fan& fan, float range) const;

  /// The same for one ray, from one primitive to the next, without the tree: to judge it by.
  Hit cast_by_brute_force(const Ray& ray, float range) const;

  const Eigen::Vector3d& origin() const { return origin_; }
  const Ground& ground() const { return ground_; }
  const std::vector<Primitive>& primitives() const { return primitives_; }

 private:
  bool intersect(std::size_t k, const Ray& ray, Hit& hit) const {
    const Primitive& p = primitives_[k];
    return simulate::intersect(
        p, p.facade < 0 ? nullptr : &facades_[static_cast<std::size_t>(p.facade)], ray, hit);
  }

  Eigen::Vector3d origin_;
  Ground ground_;
  std::vector<Primitive> primitives_;
  std::vector<Facade> facades_;
  Bvh bvh_;
};

/// A city along `path` (sensor positions [m], which the sensor holds `sensor_height` above the
/// ground): houses on both sides, at least half a `street_width` from every part of the path, so
/// that a street looks the same on each pass; walls and hedges between them, parked cars, poles,
/// trees. The same seed gives the same city. With `alike` [m] above 0 the streets repeat themselves
/// after so much of the path where the surroundings leave room for it: blocks of equal houses.
World build_city(const std::vector<Eigen::Vector3d>& path, double sensor_height,
                 double street_width, double alike, std::uint64_t seed);

}  // namespace plumb::simulate
