#include "simulate/world.hpp"

namespace plumb::simulate {

World::World(const Eigen::Vector3d& origin, Ground ground, std::vector<Primitive> primitives,
             std::vector<Facade> facades)
    : origin_(origin),
      ground_(std::move(ground)),
      primitives_(std::move(primitives)),
      facades_(std::move(facades)),
      bvh_(primitives_) {}

Hit World::cast(const Ray& ray, float range) const {
  Hit hit;
  hit.t = range;
  bool met = false;
  bvh_.along(ray, hit, [&](std::uint32_t k) { met |= intersect(k, ray, hit); });
  met |= ground_.intersect(ray, hit);
  return met ? hit : Hit();
}

Hit World::cast_by_brute_force(const Ray& ray, float range) const {
  Hit hit;
  hit.t = range;
  bool met = false;
  for (std::size_t k = 0; k < primitives_.size(); ++k) met |= intersect(k, ray, hit);
  met |= ground_.intersect(ray, hit);
  return met ? hit : Hit();
}

}  // namespace plumb::simulate
