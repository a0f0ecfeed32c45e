#include "simulate/world.hpp"

namespace plumb::simulate {

World::World(const Eigen::Vector3d& origin, Ground ground, std::vector<Primitive> primitives,
             std::vector<Facade> facades)
    : origin_(origin),
      ground_(std::move(ground)),
      primitives_(std::move(primitives)),
      facades_(std::move(facades)),
      bvh_(primitives_) {}

Hits World::cast(const Fan& fan, float range) const {
  Hits hits;
  for (Hit& hit : hits) hit.t = range;
  std::array<bool, lane_count> met{};
  bvh_.along(fan, hits, [&](std::uint32_t k, std::size_t lane) {
    met[lane] |= intersect(k, fan.ray(lane), hits[lane]);
  });
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    met[lane] |= ground_.intersect(fan.ray(lane), hits[lane]);
    if (!met[lane]) hits[lane] = Hit();
  }
  return hits;
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
